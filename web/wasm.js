/** Whether a module ended with this error: it is of no use any more. */
export const isAbort = (error) => error instanceof WebAssembly.RuntimeError || error instanceof RangeError;

/** Gives a file to a module. @param space  name of its function that makes room for one */
export function putFile(wasm, space, name, bytes) {
  const at = callWasm(wasm, space, name, bytes.length); // after which HEAPU8 may be another
  wasm.HEAPU8.set(bytes, at);
}

/** Calls a compiled function: text and byte arrays (pointer and length) are lent to it for the call. */
export function callWasm(wasm, name, ...values) {
  const lent = [];
  const lend = (size) => {
    const pointer = wasm._malloc(size || 1);
    if (!pointer) throw new WebAssembly.RuntimeError(`no memory is left for ${size} bytes`);
    return lent[lent.push(pointer) - 1];
  };
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
