/**
 * A smooth height field in closed form with its exact shadows: what two renderers can be held against that both know
 * it by samples only. Double precision; one metre wide and high, centred, y up; unit vectors point to the light.
 */

const kTurn = 2 * Math.PI;

// Cycles a metre in x and y, phase, share of the height scale.
const kWaves = [
  [3, 1, 0.3, 0.2],
  [-2, 4, 1.1, 0.15],
  [5, 6, 2.0, 0.1],
];
const kMiddle = 0.5;

/** Height and its gradient at (x, y), in units of the height scale. */
export function wavesAt(x, y) {
  let [height, slopeX, slopeY] = [kMiddle, 0, 0];
  for (const [cyclesX, cyclesY, phase, share] of kWaves) {
    const angle = kTurn * (cyclesX * x + cyclesY * y) + phase;
    const rise = share * kTurn * Math.cos(angle);
    height += share * Math.sin(angle);
    slopeX += cyclesX * rise;
    slopeY += cyclesY * rise;
  }
  return { height, slopeX, slopeY };
}

/** Centre of texel i of n along x; along y it is the negative. */
export const centreOf = (i, n) => (i + 0.5) / n - 0.5;

/** Samples at texel centres, row 0 at the top. */
export function sampleWaves(n) {
  const heights = new Float32Array(n * n);
  for (let row = 0; row < n; ++row)
    for (let column = 0; column < n; ++column)
      heights[row * n + column] = wavesAt(centreOf(column, n), -centreOf(row, n)).height;
  return heights;
}

// No wave is higher than its share, and none bends more than share (2 pi cycles)^2 in any direction.
const kHighest = kMiddle + kWaves.reduce((sum, [, , , share]) => sum + share, 0);
const kBend = kWaves.reduce((sum, [x, y, , share]) => sum + share * kTurn ** 2 * (x * x + y * y), 0);

/**
 * Whether the light reaches the surface at (x, y), where it must stand above the tangent plane.
 *
 * Along the ray, g(s) = height - altitude starts at 0 and falls. From a place where it is negative it cannot reach 0
 * before the root of g + g' s + bend s^2 / 2: steps of that length leave out nothing.
 */
function reached(x, y, scale, light) {
  const start = wavesAt(x, y).height * scale;
  const across = Math.hypot(light[0], light[1]);
  const bend = kBend * scale * across * across;
  const least = 1e-10; // m; a ray that touches the surface takes ever shorter steps
  for (let s = 0; ; ) {
    const [px, py, altitude] = [x + s * light[0], y + s * light[1], start + s * light[2]];
    if (Math.abs(px) > 0.5 || Math.abs(py) > 0.5 || altitude > kHighest * scale) return true;
    const { height, slopeX, slopeY } = wavesAt(px, py);
    const gap = s === 0 ? 0 : height * scale - altitude;
    if (gap > 0) return false;
    const fall = (slopeX * light[0] + slopeY * light[1]) * scale - light[2];
    const step = (-fall + Math.sqrt(fall * fall - 2 * bend * gap)) / bend;
    if (step < least) return false;
    s += step;
  }
}

/**
 * Exact picture from above, one pixel a texel.
 * @param scale  m for a height of 1
 * @return {Float64Array}  cosine between normal and light where the light reaches the surface, else 0
 */
export function solveWaves(n, scale, light) {
  const cosines = new Float64Array(n * n);
  for (let row = 0; row < n; ++row)
    for (let column = 0; column < n; ++column) {
      const [x, y] = [centreOf(column, n), -centreOf(row, n)];
      const { slopeX, slopeY } = wavesAt(x, y);
      const facing = light[2] - (slopeX * light[0] + slopeY * light[1]) * scale;
      if (facing > 0 && reached(x, y, scale, light))
        cosines[row * n + column] = facing / Math.hypot(1, slopeX * scale, slopeY * scale);
    }
  return cosines;
}

/** Unit vector to a light, angles in degrees: above the horizon, and from +x towards +y. */
export function directionOf(elevation, azimuth) {
  const [up, around] = [elevation, azimuth].map((degrees) => (degrees * Math.PI) / 180);
  return [Math.cos(up) * Math.cos(around), Math.cos(up) * Math.sin(around), Math.sin(up)];
}
