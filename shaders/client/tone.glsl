// Linear up to kKnee, then a shoulder that reaches 1 only at infinity: mid-tones keep their colours, highlights their
// shape. Its slope is continuous.
const float kKnee = 0.72;

vec3 displayed(vec3 radiance) {
    vec3 above = max(radiance - kKnee, 0.0) / (1.0 - kKnee);
    return min(radiance, kKnee) + (1.0 - kKnee) * (above / (above + 1.0));
}
