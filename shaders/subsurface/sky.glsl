// subsurface/sky.glsl: irradiance of an environment by the normal.
//
// in    light  block with vec4 sky[9] (src/subsurface/Sky.h)
vec3 skyLight(vec3 n) {
    return max(light.sky[0].rgb + n.y * light.sky[1].rgb + n.z * light.sky[2].rgb + n.x * light.sky[3].rgb +
                   n.x * n.y * light.sky[4].rgb + n.y * n.z * light.sky[5].rgb +
                   (3.0 * n.z * n.z - 1.0) * light.sky[6].rgb + n.x * n.z * light.sky[7].rgb +
                   (n.x * n.x - n.y * n.y) * light.sky[8].rgb,
               0.0);
}
