// Sizes and lengths in words.

/** A number of bytes with three digits: "3.66 MB". */
export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${bytes} bytes`;
  const [value, unit] = bytes < 999_500 ? [bytes / 1e3, 'KB'] : [bytes / 1e6, 'MB'];
  return `${value.toPrecision(3).replace(/e\+?\d+$/, '')} ${unit}`;
}

/** A length in metres with two digits, rounded up: "0.089 mm". */
export function lengthText(metres: number): string {
  if (metres === 0) return '0 mm';
  const millimetres = 1000 * metres;
  const step = 10 ** (Math.floor(Math.log10(millimetres)) - 1);
  const rounded = Math.ceil(millimetres / step - 1e-6) * step;
  return rounded >= 10_000 ? `${(rounded / 1000).toFixed(0)} m` : `${rounded < 1e-3 ? rounded.toExponential(1) : Number(rounded.toPrecision(2))} mm`;
}

/** A count and the word for what is counted. */
export function counted(count: number, one: string, many: string): string {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}
