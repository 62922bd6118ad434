// What the keys do.

export type Command =
  | "left" | "right" | "up" | "down" | "moveLeft" | "moveRight" | "moveUp" | "moveDown" | "nearer" | "farther"
  | "fit" | "alongX" | "alongY" | "alongZ" | "reset" | "smaller" | "larger" | "explode" | "cutMore" | "cutLess" | "flip"
  | "peelMore" | "peelLess" | "colour" | "boundary" | "singular" | "sheetNext" | "sheetBack" | "play" | "back" | "forth"
  | "hide" | "unhide" | "unpick" | "find" | "theme" | "panel" | "link" | "save" | "help";

/** For the list of keys in the page. */
export const KEYS: [string[], string][] = [
  [["drag", "← → ↑ ↓"], "turn"],
  [["right drag", "Shift + arrows"], "move"],
  [["wheel", "+", "−"], "nearer, farther"],
  [["click"], "pick a hex; double click looks at it; hover shows ids"],
  [["F", "1", "2", "3"], "fit; look along x, y, z"],
  [["[", "]", "E"], "smaller, larger hexes; explode"],
  [["K", "J", "X"], "cut more, less; other side"],
  [["L", "Shift + L"], "peel a layer more, less"],
  [["V"], "next colours"],
  [["B", "G"], "boundary; singular edges"],
  [["N", "Shift + N"], "next, previous sheet"],
  [["Space", ",", "."], "play the shelling; one back, one further"],
  [["H", "Shift + H"], "hide the picked hex; show the hidden"],
  [["/", "Esc"], "find; drop the pick"],
  [["T", "P"], "light or dark; panel"],
  [["C", "S", "0", "?"], "copy link; save picture; reset; this list"],
];

const PLAIN: Record<string, Command> = {
  ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down", "+": "nearer", "=": "nearer", "-": "farther", _: "farther",
  f: "fit", "1": "alongX", "2": "alongY", "3": "alongZ", "0": "reset", "[": "smaller", "]": "larger", e: "explode",
  k: "cutMore", j: "cutLess", x: "flip", l: "peelMore", L: "peelLess", v: "colour", b: "boundary", g: "singular",
  n: "sheetNext", N: "sheetBack", " ": "play", ",": "back", ".": "forth", h: "hide", H: "unhide", Escape: "unpick",
  "/": "find", t: "theme", p: "panel", c: "link", s: "save", "?": "help",
};

const SHIFTED: Record<string, Command> = { ArrowLeft: "moveLeft", ArrowRight: "moveRight", ArrowUp: "moveUp", ArrowDown: "moveDown" };

/** The command of a key press, unless the key belongs to the element that has the focus or to the browser. */
export function keyAction(e: KeyboardEvent): Command | null {
  if (e.ctrlKey || e.metaKey || e.altKey) return null;
  const on = e.target as HTMLElement;
  if (on.closest("dialog") || on.matches('input[type="text"], select')) return null;
  const own = on.matches("input, button, summary");
  if (own && (e.key.startsWith("Arrow") || e.key === " ")) return null;
  return (e.shiftKey && SHIFTED[e.key]) || PLAIN[e.key] || null;
}
