// Histogram of the values, the facts under it, and the colour bar of the legend.

import { css, sample, valueColour } from "./colour";
import type { MeshData, Rgb, Values } from "./data";
import { digits, make, svg } from "./dom";

const BINS = 30;

export interface Summary {
  least: number;
  greatest: number;
  mean: number;
  nonpositive: number;
  missing: number;
  /** Hexes by ascending value; those without a value are left out. */
  ascending: number[];
}

export function summarise(values: Values): Summary {
  const ascending = Array.from(values.data.keys()).filter((h) => !Number.isNaN(values.data[h]));
  ascending.sort((a, b) => values.data[a] - values.data[b] || a - b);
  const sum = ascending.reduce((s, h) => s + values.data[h], 0);
  return {
    least: ascending.length ? values.data[ascending[0]] : NaN,
    greatest: ascending.length ? values.data[ascending[ascending.length - 1]] : NaN,
    mean: sum / ascending.length,
    nonpositive: ascending.filter((h) => values.data[h] <= 0).length,
    missing: values.data.length - ascending.length,
    ascending,
  };
}

/** Bars over the range of the scale, widened to what occurs. */
export function histogram(values: Values, summary: Summary, colours: MeshData["colours"]): SVGElement {
  const low = Math.min(values.low, Math.max(summary.least, -1e30));
  const high = Math.max(values.high, Math.min(summary.greatest, 1e30));
  const width = high > low ? high - low : 1;
  const bins = new Array<number>(BINS).fill(0);
  for (const h of summary.ascending) {
    bins[Math.min(BINS - 1, Math.max(0, Math.floor(((values.data[h] - low) / width) * BINS)))]++;
  }
  const top = bins.reduce((a, b) => Math.max(a, b), 1);
  const bars = bins.map((n, i) => {
    const height = n === 0 ? 0 : Math.max(1.5, (44 * n) / top);
    const middle = low + ((i + 0.5) / BINS) * width;
    const bar = svg("rect", {
      x: (260 * i) / BINS + 0.5, y: 46 - height, width: 260 / BINS - 1, height, rx: 1,
      fill: css(valueColour(values, middle, colours.unknown, colours.flagged)),
      stroke: "currentColor", "stroke-opacity": 0.35, "stroke-width": 0.5,
    });
    bar.append(svg("title", {}, `${digits(low + (i / BINS) * width)} to ${digits(low + ((i + 1) / BINS) * width)}: ${n}`));
    return bar;
  });
  const label = (x: number, anchor: string, text: string) =>
    svg("text", { x, y: 60, "text-anchor": anchor, "font-size": 11, fill: "currentColor", "fill-opacity": 0.75 }, text);
  return svg(
    "svg",
    { viewBox: "0 0 260 64", role: "img", "aria-label": `Histogram of ${values.name}` },
    ...bars,
    svg("line", { x1: 0, x2: 260, y1: 46.5, y2: 46.5, stroke: "currentColor", "stroke-opacity": 0.4 }),
    label(0, "start", digits(low)), label(130, "middle", digits(low + width / 2)), label(260, "end", digits(high)),
  );
}

/** A legend with a colour bar. */
export function bar(title: string, ramp: Rgb[], ticks: string[], extra: HTMLElement[] = []): HTMLElement {
  const stops = Array.from({ length: 25 }, (_, i) => css(sample(ramp, i / 24))).join(", ");
  const strip = make("div", { class: "ramp" });
  strip.style.background = `linear-gradient(to right, ${stops})`;
  const legend = make("div", { class: "legend" }, make("b", {}, title), strip, make("div", { class: "ticks" }, ...ticks.map((t) => make("span", {}, t))));
  legend.append(...extra);
  return legend;
}

export function entry(colour: Rgb, text: string, square = false): HTMLElement {
  const swatch = make("span", { class: square ? "swatch square" : "swatch" });
  swatch.style.background = css(colour);
  return make("span", { class: "entry" }, swatch, text);
}
