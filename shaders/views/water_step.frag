// views/water_step.frag: one step in time of h_tt + damping h_t = speed^2 (h_xx + h_zz) between walls that
// mirror.
//
// model leapfrog; the second derivatives over nine points, whose leading error is that of a longer way and the
//       same in all directions (mehrstellen, Collatz 1960), so that rings stay round
#include "views/water_state.glsl"
layout(location = 0) out vec4 oState;

float heightAt(ivec2 texel) { return stateAt(texel).x; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 here = stateAt(at);
    float xs = heightAt(at + ivec2(-1, 0)) + heightAt(at + ivec2(1, 0));
    float zs = heightAt(at + ivec2(0, -1)) + heightAt(at + ivec2(0, 1));
    float corners = heightAt(at + ivec2(-1, -1)) + heightAt(at + ivec2(1, -1)) + heightAt(at + ivec2(-1, 1)) +
                    heightAt(at + ivec2(1, 1));
    vec2 perCell = 1.0 / (water.cell * water.cell);
    float mixed = corners - 2.0 * (xs + zs) + 4.0 * here.x;
    float bend = perCell.x * (xs - 2.0 * here.x) + perCell.y * (zs - 2.0 * here.x) +
                 (perCell.x + perCell.y) / 12.0 * mixed;
    float drag = 0.5 * water.damping * water.step;
    float rise = ((1.0 - drag) * here.y + water.step * water.speed * water.speed * bend) / (1.0 + drag);
    oState = vec4(here.x + water.step * rise, rise, 0.0, 0.0);
}
