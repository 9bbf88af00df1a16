#pragma once
/// The parts of stb that we use, with the same switches wherever they are included. The writer keeps its
/// stdio part: stb's HDR writer is inside it, even the one that writes to memory.

#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 16384 // kMaxImageSide
#include <stb_image.h>
#include <stb_image_write.h>
