// views/voxels.glsl: slices of a pixel in which surfaces lie, as views/voxel_slice.frag leaves them (thesis 2008, 3.4).
//
// Images of bits come first: slice b is bit b & 7 of channel (b >> 3) & 3 of image b >> 5. Then images of counts: how
// many surfaces lie in each byte, four bits a byte, so up to 15. A byte whose set bits are not as many as its surfaces
// was damaged: two of them lay in one slice. Bytes do not disturb each other.
#include "views/slices.glsl"
uniform sampler2DArray uVoxels;
uniform sampler2DArray uBounds; // views/voxel_bounds.frag

const int kBytes = SLICES / 8;

int byteIn(ivec2 pixel, int image, int channel) {
    return int(texelFetch(uVoxels, ivec3(pixel, image), 0)[channel] * 255.0 + 0.5);
}
int bitsOf(ivec2 pixel, int byte) { return byteIn(pixel, byte >> 2, byte & 3); }

// Surfaces in eight bytes, four bits each.
ivec4 countsOf(ivec2 pixel, int eight) {
    return ivec4(texelFetch(uVoxels, ivec3(pixel, SLICES / 32 + eight), 0) * 255.0 + 0.5);
}
int countIn(ivec4 counts, int byte) { return (counts[(byte >> 1) & 3] >> (4 * (byte & 1))) & 15; }

int setBits(int byte) {
    byte -= (byte >> 1) & 0x55;
    byte = (byte & 0x33) + ((byte >> 2) & 0x33);
    return (byte + (byte >> 4)) & 15;
}

// The place of the nth set bit, from 0, by halving.
int setBit(int byte, int nth) {
    int place = 0;
    for (int width = 4; width > 0; width >>= 1) {
        int below = setBits(byte & ((1 << width) - 1));
        if (nth < below) continue;
        nth -= below;
        byte >>= width;
        place += width;
    }
    return place;
}

// The same where fewer bits are set than surfaces lie there: bits stand for two surfaces in the slice before, the
// first ones first. Of two surfaces this is exact, of more a slice or so off.
int carriedBit(int byte, int count, int nth) {
    int in_[8];
    for (int i = 0; i < 8; ++i) in_[i] = (byte >> i) & 1;
    for (int more = count - setBits(byte); more > 0; --more) {
        int i = 1;
        while (i < 7 && in_[i] == 0) ++i;
        --in_[i];
        in_[i - 1] += 2;
    }
    int place = 0;
    while (place < 7 && nth >= in_[place]) nth -= in_[place++];
    return place;
}

// In which of a byte's slices its nth surface lies. With more bits set than surfaces it is saturated: two lie in the
// last slice, and others are said to.
int placeIn(int byte, int count, int nth) {
    int set = setBits(byte);
    if (set == count) return setBit(byte, nth);
    return set > count ? 7 : carriedBit(byte, count, nth);
}

vec2 boundsAt(ivec2 pixel, vec2 all_) {
#ifdef GLOBAL_BOUNDS
    return all_;
#else
    return vec2(-texelFetch(uBounds, ivec3(pixel, 0), 0).r, texelFetch(uBounds, ivec3(pixel, 1), 0).r);
#endif
}
