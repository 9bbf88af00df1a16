/** Attributes of an element that are its properties as well. */

const same = (value) => value;
// What a property is of an attribute's text (null: it has none), and the other way round.
const kKinds = {
  text: { of: (text) => text ?? '', from: same },
  address: { of: (text) => text ?? '', from: (value) => value || null }, // '' takes the attribute away
  number: { of: (text) => (text === null ? null : Number(text)), from: (value) => value ?? null },
  flag: { of: (text) => text !== null, from: (value) => (value ? '' : null) },
  option: { of: same, from: (value) => (value === true ? '' : value === false ? null : value) },
  loading: { of: (text) => (text === 'lazy' ? 'lazy' : 'eager'), from: same },
};

const attributeOf = (property) => property.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);

/** @param type  class of elements. @param kinds  {property: kind above} */
export function reflect(type, kinds) {
  for (const [property, kind] of Object.entries(kinds)) {
    const attribute = attributeOf(property);
    const { of, from } = kKinds[kind];
    Object.defineProperty(type.prototype, property, {
      configurable: true,
      enumerable: true,
      get() {
        return of(this.getAttribute(attribute));
      },
      set(value) {
        const text = from(value);
        if (text === null) this.removeAttribute(attribute);
        else this.setAttribute(attribute, text);
      },
    });
  }
}
