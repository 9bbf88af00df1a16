// views/textured.glsl: what textures say of a pixel of a surface image, as views/textured.frag leaves it.
uniform sampler2D uFactors;  // rgb: of the albedo; a: of the roughness
uniform sampler2D uFacets;   // xy: octahedral normal, world, towards the eye; z: factor of the share of metal; w: 0 where
                             // the pixel shows nothing with textures
uniform sampler2D uEmission; // rgb: factor of what shines by itself
