/** Calls a compiled function: text and byte arrays (pointer and length) are lent to it for the call. */
export function callWasm(wasm, name, ...values) {
  const lent = [];
  const lend = (size) => lent[lent.push(wasm._malloc(size || 1)) - 1];
  const plain = values.flatMap((value) => {
    if (typeof value === 'string') {
      const size = wasm.lengthBytesUTF8(value) + 1;
      const pointer = lend(size);
      wasm.stringToUTF8(value, pointer, size);
      return pointer;
    }
    if (value instanceof Uint8Array) {
      const pointer = lend(value.length);
      wasm.HEAPU8.set(value, pointer);
      return [pointer, value.length];
    }
    return value;
  });
  const result = wasm['_' + name](...plain);
  lent.forEach((pointer) => wasm._free(pointer));
  return result;
}
