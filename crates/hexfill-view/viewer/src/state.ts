// What is shown, and how a link carries it. Only what differs from the start is written; lengths are in units of the
// mesh's radius round its middle, so a link survives a change of unit.

export type ColourMode = "plain" | "value" | "group" | "layer" | "order";

/** Colours over the scale the page came with, or over the values that occur. */
export type Scale = "fixed" | "range";

export interface ViewState {
  shrink: number;
  explode: number;
  colour: ColourMode;
  scale: Scale;
  /** Show only hexes with a value up to this, or null for all. */
  limit: number | null;
  /** Normal of the cut plane; hexes whose centre lies further along it are cut away first. */
  normal: [number, number, number];
  /** Fraction of the extent that is cut away. */
  cut: number;
  flip: boolean;
  peel: number;
  /** "xray" is glass without hexes. */
  boundary: "edges" | "glass" | "xray" | "none";
  singular: "none" | "inside" | "all";
  /** A sheet, "all", or null. */
  sheet: number | "all" | null;
  sheetAs: "hexes" | "surface" | "place";
  chord: number | "all" | null;
  /** A column of hexes (class number), or null. */
  column: number | null;
  /** How many hexes of the order are shown, or null for all. */
  shown: number | null;
  picked: number | null;
  hidden: number[];
  theme: "auto" | "light" | "dark";
}

export function initialState(): ViewState {
  return {
    shrink: 1, explode: 0, colour: "plain", scale: "fixed", limit: null, normal: [0, -1, 0], cut: 0, flip: false, peel: 0,
    boundary: "edges", singular: "none", sheet: null, sheetAs: "hexes", chord: null, column: null,
    shown: null, picked: null, hidden: [], theme: "auto",
  };
}

/** Camera position, target and up vector. */
export type CameraNumbers = number[];

export function toHash(state: ViewState, start: ViewState, camera: CameraNumbers): string {
  const words = [`cam=${camera.map((x) => short(x)).join(",")}`];
  for (const key of Object.keys(start) as (keyof ViewState)[]) {
    const value = state[key];
    if (JSON.stringify(value) === JSON.stringify(start[key])) continue;
    const text = Array.isArray(value) ? value.map(short).join(",") : typeof value === "number" ? short(value) : String(value);
    words.push(`${key}=${text}`);
  }
  return "#" + words.join("&");
}

function short(x: number): string {
  return String(Number(x.toPrecision(5)));
}

/** Reads a link; anything it does not understand is ignored. */
export function fromHash(hash: string, start: ViewState, limits: Limits): { state: ViewState; camera: CameraNumbers | null } {
  const state: ViewState = structuredClone(start);
  let camera: CameraNumbers | null = null;
  for (const word of hash.replace(/^#/, "").split("&")) {
    const [key, text = ""] = word.split("=", 2).map(decoded);
    const numbers = text.split(",").map(Number);
    const x = numbers[0];
    const within = (low: number, high: number) => Number.isFinite(x) && x >= low && x <= high;
    const id = (n: number) => Number.isInteger(x) && x >= 0 && x < n;
    const one = <T extends string>(...words: T[]) => words.find((w) => w === text);
    switch (key) {
      case "cam":
        if (numbers.length === 9 && numbers.every(Number.isFinite)) camera = numbers;
        break;
      case "shrink": if (within(0.1, 1)) state.shrink = x; break;
      case "explode": if (within(0, 2)) state.explode = x; break;
      case "colour": state.colour = one("plain", "layer", "order", ...(limits.values ? ["value" as const] : []), ...(limits.groups ? ["group" as const] : [])) ?? start.colour; break;
      case "scale": state.scale = one("fixed", "range") ?? start.scale; break;
      case "limit": if (limits.values && Number.isFinite(x)) state.limit = x; break;
      case "normal":
        if (numbers.length === 3 && numbers.every(Number.isFinite) && Math.hypot(...numbers) > 0) state.normal = numbers as [number, number, number];
        break;
      case "cut": if (within(0, 1)) state.cut = x; break;
      case "flip": state.flip = text === "true"; break;
      case "peel": if (id(limits.layers)) state.peel = x; break;
      case "boundary": state.boundary = one("edges", "glass", "xray", "none") ?? start.boundary; break;
      case "singular": state.singular = one("none", "inside", "all") ?? start.singular; break;
      case "sheet": state.sheet = text === "all" ? "all" : id(limits.sheets) ? x : null; break;
      case "sheetAs": state.sheetAs = one("hexes", "surface", "place") ?? start.sheetAs; break;
      case "chord": state.chord = text === "all" ? "all" : id(limits.chords) ? x : null; break;
      case "column": if (id(limits.columns)) state.column = x; break;
      case "shown": if (id(limits.hexes + 1)) state.shown = x; break;
      case "picked": if (id(limits.hexes)) state.picked = x; break;
      case "theme": state.theme = one("auto", "light", "dark") ?? start.theme; break;
      case "hidden": state.hidden = numbers.filter((h) => Number.isInteger(h) && h >= 0 && h < limits.hexes); break;
    }
  }
  return { state, camera };
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return "";
  }
}

export interface Limits {
  hexes: number;
  layers: number;
  sheets: number;
  chords: number;
  columns: number;
  values: boolean;
  groups: boolean;
}
