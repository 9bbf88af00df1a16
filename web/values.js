/** Values of parameters: text on the module's side, what JavaScript expects on ours. */

/** A parameter's text as number, boolean, string or array of numbers, after its kind. */
export function valueOf(control, text) {
  switch (control.kind) {
    case 'toggle':
      return text === 'true';
    case 'choice':
      return text;
    case 'number':
    case 'integer':
      return Number(text);
    default:
      return text.split(' ').map(Number);
  }
}

/** What set() takes, as the module's text. An attribute without a value turns a toggle on, as in HTML. */
export function textOf(control, value) {
  if (Array.isArray(value)) return value.join(' ');
  return value === '' && control.kind === 'toggle' ? 'true' : String(value);
}

/** "env-rotation" -> "envRotation" */
export const camelCase = (attribute) => attribute.replace(/-(.)/g, (_, letter) => letter.toUpperCase());

/** Linear light as "#rrggbb" (IEC 61966-2-1); what a colour input cannot show is cut off. */
export function hexOfLinear(rgb) {
  const byte = (x) => {
    const light = Math.min(1, Math.max(0, x));
    const coded = light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
    return Math.round(255 * coded)
      .toString(16)
      .padStart(2, '0');
  };
  return '#' + rgb.map(byte).join('');
}
