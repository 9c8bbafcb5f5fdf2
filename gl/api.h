#pragma once
/// The only file that includes the GL loader. GL 4.5 core; needs a current context on the calling thread.

#include <epoxy/gl.h>
