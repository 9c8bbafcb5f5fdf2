#!/usr/bin/env python3
"""make_corpus.py FOLDER: small sound files of every kind the readers know, one folder per fuzz target: where the
fuzzers start from. All are made here; none is a recording."""

import base64
import json
import pathlib
import struct
import sys
import zlib


def png(width, height, bit_depth, colour_type, row):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, bit_depth, colour_type, 0, 0, 0)
    rows = b"".join(b"\0" + row(y) for y in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def pfm(width, height, depth):
    values = [depth(x, y) for y in reversed(range(height)) for x in range(width)]
    return f"Pf\n{width} {height}\n-1.0\n".encode() + struct.pack(f"<{len(values)}f", *values)


IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def layer(encoding, objects):
    return {
        "name": "main", "size_px": [4, 3], "fov_tangents": [-1, 1, -0.75, 0.75], "near_m": 0.05,
        "world_from_eye": {"position_m": [0, 1.6, 0], "orientation_xyzw": [0, 0, 0, 1]},
        "depth_encoding": encoding, "time_s": 0.5, "pose_sampled_s": 0.25, "objects": objects,
    }


def sections(*parts):
    return b"".join(struct.pack("<I", len(part)) + part for part in parts)


def frames():
    colour = png(4, 3, 8, 6, lambda y: bytes([200, 10 * y, 0, 255] * 4))
    rgb = png(4, 3, 8, 2, lambda y: bytes([1, 2, 3 + y] * 4))
    ids = png(4, 3, 16, 0, lambda y: struct.pack(">4H", 0, 1, 0, 7))
    for name, encoding, depth, picture in [
        ("reverse_z", "reverse_z", lambda x, y: 0.25 * x / 4, colour),
        ("distance", "distance_m", lambda x, y: float("inf") if x == 0 else 1.0 + y, rgb),
        ("bad_depth", "reverse_z", lambda x, y: float("nan") if x == y else -1.0, colour),
    ]:
        objects = [{"id": 1, "world_from_object": IDENTITY}, {"id": 7, "world_from_object": IDENTITY}]
        description = {"schema": "latewarp.frame/1", "index": 3, "layers": [layer(encoding, objects)]}
        yield name, sections(json.dumps(description).encode(), picture, pfm(4, 3, depth), ids)
    yield "objects", sections(json.dumps({"objects": [{"id": 2, "world_from_object": IDENTITY}]}).encode())


def ros_record(fields, data):
    header = b"".join(struct.pack("<I", len(k) + 1 + len(v)) + k + b"=" + v for k, v in fields)
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def ros_pose(sequence, time_s, position, orientation_xyzw):
    frame = b"world"
    stamp = struct.pack("<III", sequence, int(time_s), int(time_s % 1 * 1e9))
    return stamp + struct.pack("<I", len(frame)) + frame + struct.pack("<7d", *position, *orientation_xyzw)


def rosbag():
    connection = ros_record([(b"op", b"\x07"), (b"conn", struct.pack("<I", 0)), (b"topic", b"/head")],
                            b"".join(struct.pack("<I", len(f)) + f for f in
                                     [b"topic=/head", b"type=geometry_msgs/PoseStamped",
                                      b"md5sum=d3812c3cbc69362b77dc0b19b345f8f5", b"message_definition="]))
    messages = b"".join(
        ros_record([(b"op", b"\x02"), (b"conn", struct.pack("<I", 0)), (b"time", struct.pack("<II", i, 0))],
                   ros_pose(i, 1.0 + 0.02 * i, (0.1 * i, 1.6, 0.0), (0.0, 0.0, 0.0, 1.0))) for i in range(4))
    chunk = ros_record([(b"op", b"\x05"), (b"compression", b"none"), (b"size", struct.pack("<I", len(connection + messages)))],
                       connection + messages)
    head = ros_record([(b"op", b"\x03"), (b"index_pos", struct.pack("<Q", 0)), (b"conn_count", struct.pack("<I", 1)),
                       (b"chunk_count", struct.pack("<I", 1))], b" " * 64)
    return b"#ROSBAG V2.0\n" + head + chunk


def traces():
    rows = range(6)
    yield "latewarp.csv", "time_s,px_m,py_m,pz_m,qx,qy,qz,qw\n" + "".join(
        f"{0.01 * i},{0.1 * i},1.6,0,0,{0.01 * i},0,1\n" for i in rows)
    yield "gaps.csv", "time_s,px_m,py_m,pz_m,qx,qy,qz,qw\r\n0,0,0,0,0,0,0,1\r\nnan,0,0,0,0,0,0,1\r\n5,1,1,1,0,0,0,-1\r\n"
    yield "pose_stamped.csv", "t_s,x,y,z,qx,qy,qz,qw\n" + "".join(
        f"{0.02 * i},{0.1 * i},1.6,0,0,0,0,1\n" for i in rows)
    yield "unity.csv", "".join(
        f"{0.016 * i:.3f}," + ",".join(f"{0.1 * (i + k):.4f}" for k in range(15)) + "\n" for i in rows)
    yield "eyenavgs.csv", (
        "ViewIndex,FOV1,FOV2,FOV3,FOV4,PositionX,PositionY,PositionZ,QuaternionX,QuaternionY,QuaternionZ,QuaternionW,"
        "Timestamp\n") + "".join(f"{i % 2},-0.9,0.9,0.9,-0.9,{0.1 * i},1.6,0,0,0,0,1,{i // 2 * 10}\n" for i in rows)
    yield "questset.csv", (
        "Timestamp,HeadPosX,HeadPosY,HeadPosZ,HeadRotW,HeadRotX,HeadRotY,HeadRotZ\n") + "".join(
        f"{10 * i},{0.1 * i},1.6,0,1,0,0,0\n" for i in rows)
    yield "recording.bag", rosbag()


def triangle(extra=None, mode=4):
    positions = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    texture = struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    indices = struct.pack("<3H2x", 0, 1, 2)
    times = struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 1, 0, 0)
    data = positions + texture + indices + times
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "rotation": [0, 0, 0, 1]}, {"camera": 0, "translation": [0, 1, 3]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"uri": "data:image/png;base64," +
                    base64.b64encode(png(2, 2, 8, 2, lambda y: bytes([9, 9, 9 * y] * 2))).decode()}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0, "mode": mode}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 4, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
            {"buffer": 0, "byteOffset": 60, "byteLength": 6}, {"buffer": 0, "byteOffset": 68, "byteLength": 8},
            {"buffer": 0, "byteOffset": 76, "byteLength": 24}],
        "buffers": [{"byteLength": len(data)}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                        "samplers": [{"input": 3, "output": 4}]}],
    }
    document.update(extra or {})
    return document, data


def glb(document, data):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def gltfs():
    document, data = triangle()
    yield "triangle.glb", glb(document, data)
    yield "strip.glb", glb(*triangle(mode=5))
    lights = {"extensionsUsed": ["KHR_lights_punctual"],
              "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 5}]}}}
    yield "lights.glb", glb(*triangle(lights))
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    yield "triangle.gltf", json.dumps(document)


def main():
    root = pathlib.Path(sys.argv[1])
    for target, files in [("frame", frames()), ("trace", traces()), ("gltf", gltfs())]:
        folder = root / target
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files:
            (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


if __name__ == "__main__":
    main()
