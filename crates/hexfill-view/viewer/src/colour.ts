// Colours that the data do not bring: valences, categories, overlays.

import type { Rgb, Values } from "./data";
import type { Scale } from "./state";

export function sample(ramp: Rgb[], t: number): Rgb {
  const last = ramp.length - 1;
  const at = Math.min(Math.max(t, 0), 1) * last;
  const i = Math.min(Math.floor(at), last - 1);
  const mix = (c: number) => Math.round(ramp[i][c] + (at - i) * (ramp[i + 1][c] - ramp[i][c]));
  return [mix(0), mix(1), mix(2)];
}

export function css(c: Rgb): string {
  return `rgb(${c[0]} ${c[1]} ${c[2]})`;
}

/** The values with the ends of their scale where the state wants them. */
export function onScale(values: Values, scale: Scale): Values {
  return scale === "fixed" ? values : { ...values, low: values.least, high: values.greatest };
}

/** As `Scale::colour` of `src/colour.rs`. */
export function valueColour(values: Values, x: number, unknown: Rgb, flagged: Rgb): Rgb {
  if (Number.isNaN(x)) return unknown;
  if (values.flagsNonpositive && x <= 0) return flagged;
  const width = values.high - values.low;
  return sample(values.ramp, width > 0 ? (x - values.low) / width : 0.5);
}

/** Colours that stay apart for most eyes (after Okabe and Ito), then the golden angle round the circle of hues. */
const CATEGORIES: Rgb[] = [
  [230, 130, 0], [56, 150, 220], [0, 158, 115], [213, 80, 20], [190, 110, 170], [0, 100, 178],
  [220, 200, 40], [120, 120, 130], [140, 86, 50], [90, 190, 190], [150, 60, 160], [110, 150, 30],
];

export function category(i: number): Rgb {
  if (i < CATEGORIES.length) return CATEGORIES[i];
  const hue = (i * 137.508) % 360;
  const light = [0.5, 0.62, 0.4][i % 3];
  const part = (n: number) => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (light - 0.62 * Math.min(light, 1 - light) * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [part(0), part(8), part(4)];
}

/** Edges by number of hexes; "+1" is one hex more than a regular edge has (4 inside, 2 on the boundary). */
export const EXCESS: { of: (excess: number) => boolean; colour: Rgb }[] = [
  { of: (e) => e <= -2, colour: [150, 60, 170] },
  { of: (e) => e === -1, colour: [222, 45, 38] },
  { of: (e) => e === 1, colour: [30, 110, 220] },
  { of: (e) => e === 2, colour: [0, 150, 110] },
  { of: (e) => e >= 3, colour: [224, 140, 0] },
];
