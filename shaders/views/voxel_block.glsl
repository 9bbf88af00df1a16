layout(std140) uniform VoxelBlock {
    vec2 bounds;  // nearest and farthest depth of all [m]
    ivec2 size;   // of the picture, or of the image that is reduced
    ivec2 blocks; // of the reduced image
    int count;    // surfaces behind each other
} voxels;
