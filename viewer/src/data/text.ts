// Numbers as people read them.

const PREFIXES: [number, string][] = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""]];
/** Units that take a prefix; metres and seconds stay as they are. */
const PREFIXED = new Set(["N", "J", "W", "Pa", "N m", "N·m"]);

/** Four digits, without needless zeros. */
export function short(x: number, digits = 4): string {
  if (!Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  const text = size >= 1e6 || size < 1e-4 ? x.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e") : String(Number(x.toPrecision(digits)));
  return text.replace("-", "−");
}

/** With its unit: `12.3 kN`. */
export function withUnit(x: number, unit: string, digits = 4): string {
  if (!unit || unit === "-") return short(x, digits);
  if (!PREFIXED.has(unit) || !Number.isFinite(x)) return `${short(x, digits)} ${unit}`;
  const [factor, prefix] = PREFIXES.find(([f]) => Math.abs(x) >= f) ?? [1, ""];
  return `${short(x / factor, digits)} ${prefix}${unit}`;
}

/** Times all with as many decimals as tell two frames of the run apart. */
export function timeText(t: number, span: number): string {
  const decimals = Math.min(6, Math.max(0, 3 - Math.floor(Math.log10(span || 1))));
  return t.toFixed(decimals).replace("-", "−");
}
