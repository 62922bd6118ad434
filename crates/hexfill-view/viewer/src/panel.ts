// The panel: inputs that write the state, and texts that follow it.

import { category, EXCESS, onScale } from "./colour";
import type { Groups, MeshData } from "./data";
import { button, byId, count, digits, make } from "./dom";
import { bar, entry, histogram, summarise, type Summary } from "./histogram";
import { excess } from "./lines";
import type { ColourMode, Scale, ViewState } from "./state";
import type { Topology } from "./topology";
import { hexesShown } from "./viewer";

/** Longest list of sheets or chords offered by name. */
const MOST_OPTIONS = 2000;
/** Most groups in the legend. */
const MOST_GROUPS = 40;

export interface Actions {
  update(change: Partial<ViewState>): void;
  state(): ViewState;
  pick(hex: number): void;
  viewNormal(): [number, number, number];
}

export class Panel {
  private readonly summary: Summary | null;

  constructor(private readonly data: MeshData, private readonly t: Topology, private readonly act: Actions) {
    this.summary = data.values && summarise(data.values);
    byId("title").textContent = data.title;
    const inner = data.hexes * 6 - t.boundaryFacets.length;
    byId("summary").textContent = [
      count(data.hexes, "hex", "hexes"), count(data.vertices, "vertex", "vertices"),
      count(t.boundaryFacets.length, "boundary quad"), count(inner / 2, "inner quad"), count(t.sheets.length, "sheet"),
    ].join("  ·  ");
    byId("problems").append(...data.problems.map((p) => make("li", {}, p)));
    byId("facts").append(...data.facts.map(([k, v]) => make("tr", {}, make("th", { scope: "row" }, k), make("td", {}, v))));
    if (data.facts.length === 0) byId("facts").closest("details")!.hidden = true;
    byId("order-title").textContent = data.shelling ? "Shelling" : "Build up (by index)";
    this.options();
    this.values();
    this.listen();
  }

  private options(): void {
    const { data, t } = this;
    const colour = byId<HTMLSelectElement>("colour");
    colour.append(new Option("plain", "plain"));
    if (data.values) colour.append(new Option(data.values.name, "value"));
    if (data.groups) colour.append(new Option("groups of quads", "group"));
    colour.append(new Option("layer from boundary", "layer"), new Option(data.shelling ? "shelling order" : "index order", "order"));
    const list = (select: HTMLSelectElement, name: string, lengths: string[]) => {
      select.append(new Option("none", ""), new Option(`all ${lengths.length}`, "all"));
      lengths.slice(0, MOST_OPTIONS).forEach((text, i) => select.append(new Option(`${name}${i}: ${text}`, String(i))));
      if (lengths.length > MOST_OPTIONS) select.append(new Option(`(the first ${MOST_OPTIONS} only)`, ""));
    };
    list(byId("sheet"), "s", t.sheets.map((s) => count(s.quads.length, "quad") + (s.selfCrossings ? ", self-crossing" : "")));
    list(byId("chord"), "c", t.chords.map((c) => count(c.length, "quad") + (c.selfCrossings ? ", self-crossing" : "")));
    byId<HTMLInputElement>("peel").max = String(t.layers - 1);
    byId<HTMLInputElement>("shown").max = String(data.hexes);
  }

  private values(): void {
    const { values } = this.data;
    const s = this.summary;
    if (!values || !s) return;
    byId("values").hidden = false;
    byId("scale-row").hidden = !(values.least < values.greatest) || (values.least === values.low && values.greatest === values.high);
    byId("scale-fixed").textContent = `${digits(values.low)} to ${digits(values.high)}`;
    const words = [`least ${digits(s.least)}`, `mean ${digits(s.mean)}`, `greatest ${digits(s.greatest)}`];
    if (values.flagsNonpositive && s.nonpositive > 0) words.push(`${s.nonpositive} not positive`);
    if (s.missing > 0) words.push(`${s.missing} without a value`);
    byId("value-facts").textContent = words.join(", ");
    for (const h of s.ascending.slice(0, 6)) {
      byId("worst").append(button(`h${h}`, () => this.act.pick(h), { class: "link", title: digits(values.data[h]) }), " ");
    }
  }

  /** Value at a place 0 to 1 of the limit slider: its lower half of the hexes gets most of the way. */
  private limitAt(part: number): number | null {
    const s = this.summary!;
    if (part >= 1 || s.ascending.length === 0) return null;
    return this.data.values!.data[s.ascending[Math.floor(part * (s.ascending.length - 1))]];
  }

  private listen(): void {
    const { update } = this.act;
    const slider = (id: string, act: (x: number) => void) =>
      byId<HTMLInputElement>(id).addEventListener("input", (e) => act(Number((e.target as HTMLInputElement).value)));
    const select = (id: string, act: (text: string) => void) =>
      byId<HTMLSelectElement>(id).addEventListener("change", (e) => act((e.target as HTMLSelectElement).value));
    slider("shrink", (shrink) => update({ shrink }));
    slider("explode", (explode) => update({ explode }));
    slider("cut", (cut) => update({ cut }));
    slider("peel", (peel) => update({ peel }));
    slider("limit", (x) => update({ limit: this.limitAt(x) }));
    slider("shown", (n) => update({ shown: n >= this.data.hexes ? null : n }));
    select("colour", (text) => update({ colour: text as ColourMode }));
    select("boundary", (text) => update({ boundary: text as ViewState["boundary"] }));
    select("singular", (text) => update({ singular: text as ViewState["singular"] }));
    select("theme", (text) => update({ theme: text as ViewState["theme"] }));
    const chosen = (text: string) => (text === "" ? null : text === "all" ? text : Number(text));
    select("sheet", (text) => {
      const sheet = chosen(text);
      update({ sheet, column: null, ...(sheet === "all" ? { sheetAs: "surface" as const } : {}) });
    });
    select("sheet-as", (text) => update({ sheetAs: text as ViewState["sheetAs"] }));
    select("chord", (text) => update({ chord: chosen(text) }));
    byId("cut-flip").addEventListener("click", () => update({ flip: !this.act.state().flip }));
    byId("scale-fixed").addEventListener("click", () => update({ scale: "fixed" }));
    byId("scale-range").addEventListener("click", () => update({ scale: "range" }));
    for (const b of document.querySelectorAll<HTMLButtonElement>(".cut-axis")) {
      b.addEventListener("click", () => {
        const axis = Number(b.dataset.axis);
        const normal = ([[1, 0, 0], [0, -1, 0], [0, 0, 1]] as [number, number, number][])[axis] ?? this.act.viewNormal();
        // A plane that cuts nothing would look like a dead button.
        update({ normal, cut: this.act.state().cut || 0.5 });
      });
    }
    byId("unhide").addEventListener("click", () => update({ hidden: [] }));
  }

  /** Makes every input and text follow the state. */
  follow(s: ViewState, shown: number, order: Uint32Array): void {
    const { data, t } = this;
    const set = (id: string, value: string | number) => {
      const input = byId<HTMLInputElement>(id);
      if (input.value !== String(value)) input.value = String(value);
    };
    set("shrink", s.shrink);
    set("explode", s.explode);
    set("cut", s.cut);
    set("peel", s.peel);
    set("shown", s.shown ?? data.hexes);
    set("colour", s.colour);
    set("boundary", s.boundary);
    set("singular", s.singular);
    set("sheet", s.sheet ?? "");
    set("sheet-as", s.sheetAs);
    set("chord", s.chord ?? "");
    set("theme", s.theme);
    if (this.summary && s.limit === null) set("limit", 1);
    const text = (id: string, words: string) => (byId(id).textContent = words);
    text("shrink-out", `${Math.round(100 * s.shrink)} %`);
    text("explode-out", s.explode === 0 ? "off" : s.explode.toFixed(2));
    text("cut-out", s.cut === 0 ? "off" : `${Math.round(100 * s.cut)} %`);
    text("peel-out", s.peel === 0 ? "off" : `${s.peel} of ${t.layers - 1}`);
    text("limit-out", s.limit === null ? "all" : digits(s.limit));
    text("shown-out", `${(s.shown ?? data.hexes).toLocaleString("en")} of ${data.hexes.toLocaleString("en")}${s.shown ? ` (last: h${order[s.shown - 1]})` : ""}`);
    byId("cut-flip").setAttribute("aria-pressed", String(s.flip));
    for (const b of document.querySelectorAll<HTMLButtonElement>(".cut-axis")) {
      const along = s.normal.findIndex((x) => Math.abs(x) === 1);
      b.setAttribute("aria-pressed", String(s.cut > 0 && Number(b.dataset.axis) === (along < 0 ? 3 : along)));
    }
    this.scale(s.scale);
    byId("sheet-as-row").hidden = s.sheet === null;
    text("sheet-facts", this.sheetFacts(s));
    text("chord-facts", this.chordFacts(s));
    byId("unhide").hidden = s.hidden.length === 0;
    byId("unhide").textContent = `Show ${count(s.hidden.length, "hidden hex", "hidden hexes")}`;
    text("status", shown === data.hexes ? "" : `${shown.toLocaleString("en")} of ${count(data.hexes, "hex", "hexes")} shown`);
    byId("legends").replaceChildren(...this.legends(s, shown));
  }

  /** The buttons of the scale, and the histogram in its colours. */
  private scale(scale: Scale): void {
    byId("scale-fixed").setAttribute("aria-pressed", String(scale === "fixed"));
    byId("scale-range").setAttribute("aria-pressed", String(scale === "range"));
    const { values, colours } = this.data;
    const box = byId("histogram");
    if (!values || !this.summary || box.dataset.scale === scale) return;
    box.dataset.scale = scale;
    box.replaceChildren(histogram(onScale(values, scale), this.summary, colours));
  }

  private sheetFacts(s: ViewState): string {
    if (typeof s.sheet === "number") {
      const sheet = this.t.sheets[s.sheet];
      const chords = this.t.chords.flatMap((c, i) => (c.sheet === s.sheet ? [`c${i}`] : []));
      const crossing = sheet.selfCrossings ? `crosses itself in ${count(sheet.selfCrossings, "hex", "hexes")}` : "does not cross itself";
      return `${count(sheet.quads.length, "quad")}; ${crossing}; meets the boundary in ${chords.length ? chords.slice(0, 8).join(", ") + (chords.length > 8 ? ", ..." : "") : "no chord"}`;
    }
    if (s.sheet === "all") {
      const crossing = this.t.sheets.filter((x) => x.selfCrossings > 0).length;
      return `${count(this.t.sheets.length, "sheet")}, ${crossing} of them self-crossing`;
    }
    return s.column === null ? "" : `column ${s.column} is shown alone`;
  }

  private chordFacts(s: ViewState): string {
    if (typeof s.chord !== "number") return "";
    const chord = this.t.chords[s.chord];
    const crossings = chord.selfCrossings ? `${count(chord.selfCrossings, "self-crossing")} (${chord.passages} passages)` : "no self-crossing";
    return `${count(chord.length, "quad")}, ${crossings}; boundary of sheet s${chord.sheet}`;
  }

  /** The groups with their numbers of facets; only the first ones by name. */
  private groupLegend(groups: Groups): HTMLElement {
    const sizes = groups.names.map(() => 0);
    groups.of.forEach((g) => sizes[g]++);
    const entries = groups.names.slice(0, MOST_GROUPS).map((name, g) => entry(groups.colours[g], `${name}: ${sizes[g]}`, true));
    const more = groups.names.length - MOST_GROUPS;
    return make("div", { class: "legend" }, make("b", {}, "Groups of quads"), make("div", {}, ...entries, more > 0 ? `and ${more} more` : ""));
  }

  private legends(s: ViewState, shown: number): HTMLElement[] {
    const { data, t } = this;
    const legends: HTMLElement[] = [];
    const line = (...entries: (HTMLElement | string)[]) => make("div", {}, ...entries);
    if (s.singular !== "none") {
      const counts = (boundary: boolean) => {
        const rows = EXCESS.map((kind, i) => {
          let n = 0;
          for (let e = 0; e < t.edges.count; e++) if (Boolean(t.edges.onBoundary[e]) === boundary && kind.of(excess(t, e))) n++;
          const valence = (boundary ? 2 : 4) + (i < 2 ? i - 2 : i - 1);
          const word = i === 0 ? `${valence} or less` : i === 4 ? `${valence} or more` : `${valence}`;
          return { n, colour: kind.colour, word };
        }).filter((r) => r.n > 0);
        return rows.length ? line(...rows.map((r) => entry(r.colour, `${r.word} hexes: ${r.n}`))) : line("none");
      };
      legends.push(make("div", { class: "legend" }, make("b", {}, "Inner edges by valence (4 is regular)"), counts(false),
        ...(s.singular === "all" ? [make("b", {}, "Boundary edges by valence (2 is regular)"), counts(true)] : [])));
    }
    const values = data.values && onScale(data.values, s.scale);
    const coloured = hexesShown(s);
    if (coloured && s.colour === "value" && values) {
      const extra = [];
      if (values.flagsNonpositive && this.summary!.nonpositive > 0) extra.push(entry(data.colours.flagged, `0 or less: ${this.summary!.nonpositive}`, true));
      if (this.summary!.missing > 0) extra.push(entry(data.colours.unknown, `no value: ${this.summary!.missing}`, true));
      const ticks = [0, 0.5, 1].map((p) => digits(values.low + p * (values.high - values.low)));
      legends.push(bar(values.name, values.ramp, ticks, extra.length ? [line(...extra)] : []));
    } else if (coloured && s.colour === "group" && data.groups) {
      legends.push(this.groupLegend(data.groups));
    } else if (coloured && s.colour === "layer") {
      legends.push(bar("Layer from the boundary", data.colours.growth, t.layers > 1 ? ["0", String(t.layers - 1)] : ["", "0", ""]));
    } else if (coloured && s.colour === "order") {
      legends.push(bar(data.shelling ? "Place in the shelling" : "Index", data.colours.growth, ["first", "last"]));
    } else if (coloured && s.sheet === null && (shown < data.hexes || s.shrink < 1 || s.explode > 0)) {
      legends.push(make("div", { class: "legend" }, line(entry(data.colours.surface, "boundary", true), entry(data.colours.inside, "inside", true))));
    }
    const named = (name: string, chosen: number | "all" | null, n: number) => {
      if (chosen === null || (chosen === "all" && n > 12)) return;
      const ids = chosen === "all" ? Array.from({ length: n }, (_, i) => i) : [chosen];
      const word = name === "s" ? "Sheet" : "Chord";
      legends.push(make("div", { class: "legend" }, make("b", {}, ids.length === 1 ? word : word + "s"), line(...ids.map((i) => entry(category(i), name + i, name === "s")))));
    };
    if (s.sheet !== "all" || s.sheetAs === "surface") named("s", s.sheet, t.sheets.length);
    named("c", s.chord, t.chords.length);
    return legends;
  }
}
