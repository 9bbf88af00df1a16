// caustics/spread.glsl: the parallelograms over which rays of what no beam carries are spread (caustics/spread.frag).
const float kPoint = 1.0;
const float kParallelogram = 2.0;

float areaOf(vec4 sides) { return sides.x * sides.w - sides.y * sides.z; }

// From texels beside the middle to the parallelogram's own coordinates, -1/2 to 1/2: two rows.
vec4 inverseOf(vec4 sides) { return vec4(sides.w, -sides.z, -sides.y, sides.x) / areaOf(sides); }

bool isOnParallelogram(vec4 inverse_, vec2 beside) {
    return max(abs(dot(inverse_.xy, beside)), abs(dot(inverse_.zw, beside))) <= 0.5;
}
