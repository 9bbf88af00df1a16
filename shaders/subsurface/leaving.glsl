// subsurface/leaving.glsl: the share of light that entered at a point and leaves at a place.
//
// in    uTable  the band at r = reach (i / (n - 1))²: [1/m²]; OFFSET: its share of the profile
// model R_d of the distance through space. OFFSET: of the distances to sources moved along the normal at the point
//       (Jensen et al. 2001). Where M_d is painted the way is times M_d, and so are the poles' depths: a medium M_d
//       times as dense
uniform sampler2D uTable;

vec3 bandAt(float r) {
    int last = textureSize(uTable, 0).x - 1;
    float u = sqrt(r / splat.reach) * float(last);
    int low = min(int(u), last - 1);
    return mix(texelFetch(uTable, ivec2(low, 0), 0).rgb, texelFetch(uTable, ivec2(low + 1, 0), 0).rgb, u - float(low));
}

#ifdef OFFSET
// alpha' / (4 pi) (1 + sigma_tr d) e^(-sigma_tr d) / d³ of each pole, times its weight.
vec3 offsetProfile(vec3 away, vec3 normal) {
    const float kPi = 3.14159265;
    vec3 sum = vec3(0.0);
    int count = int(splat.depths[0].a);
    for (int i = 0; i < count; ++i) {
        vec3 depths = splat.depths[i].rgb;
        // |away + depth n|, but no nearer than on a plane (src/diffusion/Profile.h)
        vec3 square = dot(away, away) + depths * (2.0 * dot(away, normal) + depths);
        vec3 d = sqrt(max(square, depths * depths));
        vec3 fall = splat.transport.rgb * d;
        sum += splat.weights[i].rgb * (1.0 + fall) * exp(-fall) / (d * d * d);
    }
    return splat.albedo.rgb / (4.0 * kPi) * sum;
}
#endif

// 1/m², of the band.
vec3 leaving(vec3 away, vec3 normal) {
    float r = length(away);
    if (r >= splat.reach) return vec3(0.0);
#ifdef OFFSET
    return bandAt(r) * offsetProfile(away, normal);
#else
    return bandAt(r);
#endif
}
