// subsurface/points.glsl: the surface of an object as a light sees it, or along an axis, as points.
//
// A point stands for a block of the view's pixels; a level of points is three images.
// place   xyz: world, middle of the block's light; w: nearest depth [m]
// flux    rgb: that enters [W]; w: farthest depth [m]
// normal  xyz: outward, unit, the mean; w: how wide the block's part of the surface is [m]
// sharpness  PAINTED, a fourth one: M_d, the mean; the width above is then times M_d
// A block without light has flux 0.
layout(location = 0) out vec4 oPlace;
layout(location = 1) out vec4 oFlux;
layout(location = 2) out vec4 oNormal;
#ifdef PAINTED
layout(location = 3) out float oSharpness;
#endif

const float kNowhere = 1e30;

void noPoint() {
    oPlace = vec4(0.0, 0.0, 0.0, kNowhere);
    oFlux = vec4(0.0, 0.0, 0.0, -kNowhere);
    oNormal = vec4(0.0);
#ifdef PAINTED
    oSharpness = 1.0;
#endif
}
