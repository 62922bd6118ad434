// Entry: reads the data, starts the viewer, ties pointer, keys, panel and link together.
// Without WebGL, or when anything fails at the start, the still picture stays and says why.

import { Vector3 } from "three";
import { readData, type MeshData } from "./data";
import { button, byId, count, digits, make } from "./dom";
import { KEYS, keyAction, type Command } from "./keys";
import { Panel } from "./panel";
import { fromHash, initialState, toHash, type ViewState } from "./state";
import { analyse, EDGES, facetVertices, type Topology } from "./topology";
import { Viewer } from "./viewer";

/** Part of a mesh that is cut away when its page opens. */
const OPENING_CUT = 0.5;

function fail(error: unknown): void {
  document.body.classList.remove("ready");
  const reason = error instanceof Error ? error.message : String(error);
  byId("why").textContent = `The interactive view could not start: ${reason}. This is a still picture. Another browser, or hardware acceleration in the browser's settings, may help.`;
  console.error(error);
}

function start(): void {
  const data = readData();
  const t = analyse(data.vertices, data.corners);
  // The canvas needs its size before the viewer starts.
  document.body.classList.add("ready");
  const canvas = byId<HTMLCanvasElement>("canvas");
  const viewer = new Viewer(canvas, data, t);
  canvas.addEventListener("webglcontextlost", (e) => {
    e.preventDefault();
    fail(new Error("the graphics card was taken away (reload the page to try again)"));
  });
  new App(data, t, viewer, canvas);
}

interface Shared {
  camera: number[];
  change: Pick<ViewState, "normal" | "cut" | "flip" | "shrink" | "explode">;
}

class App {
  private state: ViewState;
  private readonly first: ViewState;
  private readonly panel: Panel;
  private readonly systemDark = window.matchMedia("(prefers-color-scheme: dark)");
  /** Vertices marked by the last search. */
  private marked: number[] = [];
  private playing = 0;
  private played = 0;
  private hashTimer = 0;
  /** What the page beside this one knows. */
  private told = "";

  constructor(private readonly data: MeshData, private readonly t: Topology, private readonly viewer: Viewer, private readonly canvas: HTMLCanvasElement) {
    this.first = initialState();
    if (data.values) this.first.colour = "value";
    if (data.groups?.first) this.first.colour = "group";
    this.state = structuredClone(this.first);
    this.panel = new Panel(data, t, {
      update: (change) => this.update(change),
      state: () => this.state,
      pick: (h) => this.pick(h, true),
      viewNormal: () => viewer.camera.position.clone().sub(viewer.controls.target).normalize().toArray(),
    });
    viewer.onRender = () => {
      this.labels();
      window.clearTimeout(this.hashTimer);
      this.hashTimer = window.setTimeout(() => this.writeHash(), 300);
      this.tellTwin();
    };
    window.addEventListener("message", (e) => {
      if (window.parent !== window && e.source === window.parent && e.data?.hexfill === "view") this.followTwin(e.data);
    });
    if (window.parent !== window) {
      // In a frame there is no address to link to, and often little room.
      byId("link").hidden = true;
      document.body.classList.toggle("folded", window.innerWidth < 900);
    }
    this.listen();
    this.readHash();
    this.systemDark.addEventListener("change", () => this.update({}));
  }

  /** What a page beside this one (`pair.html`) shares: the camera, and what is cut, shrunk and pulled apart. */
  private shared(): Shared {
    const { normal, cut, flip, shrink, explode } = this.state;
    return { camera: this.viewer.cameraNumbers.map((x) => Number(x.toFixed(5))), change: { normal, cut, flip, shrink, explode } };
  }

  private tellTwin(): void {
    if (window.parent === window) return;
    const told = JSON.stringify(this.shared());
    if (told === this.told) return;
    this.told = told;
    window.parent.postMessage({ hexfill: "view", ...this.shared() }, "*");
  }

  /** Shows what the page beside shows, and does not tell it back. */
  private followTwin({ camera, change }: Shared): void {
    this.told = JSON.stringify({ camera, change });
    if (JSON.stringify(this.shared()) === this.told) return;
    this.update(change);
    this.viewer.cameraNumbers = camera;
  }

  private update(change: Partial<ViewState>): void {
    const before = this.state.picked;
    this.state = { ...this.state, ...change };
    const dark = this.state.theme === "dark" || (this.state.theme === "auto" && this.systemDark.matches);
    document.documentElement.toggleAttribute("data-dark", dark);
    this.viewer.apply(this.state, dark);
    this.panel.follow(this.state, this.viewer.shown, this.viewer.order);
    if (before !== this.state.picked) {
      this.marked = [];
      this.describePicked();
    }
  }

  // ---- link

  private readHash(): void {
    const limits = {
      hexes: this.data.hexes, layers: this.t.layers, sheets: this.t.sheets.length, chords: this.t.chords.length,
      columns: this.t.columnOf.reduce((a, b) => Math.max(a, b + 1), 0), values: this.data.values !== null,
      groups: this.data.groups !== null,
    };
    const { state, camera } = fromHash(location.hash, this.first, limits);
    // Opens cut, where there is an inside to see; a link says itself what is cut, and Reset shows the whole.
    this.update(location.hash.length < 2 && this.t.layers > 1 ? { ...state, cut: OPENING_CUT } : state);
    if (camera) this.viewer.cameraNumbers = camera;
    else this.viewer.fit();
  }

  private writeHash(): void {
    // Some browsers forbid this for files; the button still copies the link.
    try {
      history.replaceState(null, "", toHash(this.state, this.first, this.viewer.cameraNumbers));
    } catch {
      /* as above */
    }
  }

  private async copyLink(): Promise<void> {
    const link = location.href.replace(/#.*/, "") + toHash(this.state, this.first, this.viewer.cameraNumbers);
    try {
      await navigator.clipboard.writeText(link);
      this.say("Link copied");
    } catch {
      const field = byId<HTMLInputElement>("link-text");
      field.value = link;
      byId<HTMLDialogElement>("link-dialog").showModal();
      field.select();
      if (document.execCommand("copy")) {
        byId<HTMLDialogElement>("link-dialog").close();
        this.say("Link copied");
      }
    }
  }

  private async save(): Promise<void> {
    const style = getComputedStyle(document.documentElement);
    const picture = await this.viewer.picture(style.getPropertyValue("--ground-top"), style.getPropertyValue("--ground-bottom"));
    const link = make("a", { download: `${this.data.title.replace(/[^\w.-]+/g, "-").slice(0, 60) || "mesh"}.png`, href: URL.createObjectURL(picture) });
    link.click();
    window.setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  private say(words: string): void {
    byId("status").textContent = words;
  }

  // ---- pointer and keys

  private listen(): void {
    const { canvas, viewer } = this;
    const tip = byId("tip");
    let down: [number, number] | null = null;
    let waiting: PointerEvent | null = null;
    canvas.addEventListener("pointerdown", (e) => {
      down = [e.offsetX, e.offsetY];
      canvas.focus({ preventScroll: true });
      tip.hidden = true;
    });
    canvas.addEventListener("pointerup", (e) => {
      if (down && e.button === 0 && Math.hypot(e.offsetX - down[0], e.offsetY - down[1]) < 4) {
        const facet = viewer.facetAt(e.offsetX, e.offsetY);
        this.pick(facet < 0 ? null : Math.floor(facet / 6), false);
      }
      down = null;
    });
    canvas.addEventListener("dblclick", (e) => {
      const facet = viewer.facetAt(e.offsetX, e.offsetY);
      if (facet >= 0) viewer.lookAt(this.centre(Math.floor(facet / 6)));
    });
    canvas.addEventListener("pointermove", (e) => {
      if (e.buttons !== 0) return;
      if (!waiting) {
        requestAnimationFrame(() => {
          const at = waiting!;
          waiting = null;
          this.hover(at.offsetX, at.offsetY);
        });
      }
      waiting = e;
    });
    canvas.addEventListener("pointerleave", () => {
      viewer.hover(-1);
      tip.hidden = true;
    });
    document.addEventListener("keydown", (e) => {
      const command = keyAction(e);
      if (command) {
        e.preventDefault();
        this.run(command);
      }
    });
    const click = (id: string, command: Command) => byId(id).addEventListener("click", () => this.run(command));
    click("fit", "fit");
    click("reset", "reset");
    click("help-open", "help");
    click("panel-open", "panel");
    click("panel-close", "panel");
    click("play", "play");
    click("back", "back");
    click("forth", "forth");
    click("link", "link");
    click("save", "save");
    for (const b of document.querySelectorAll<HTMLButtonElement>("button.axis")) {
      b.addEventListener("click", () => viewer.lookAlong(Number(b.dataset.axis)));
    }
    byId("find-form").addEventListener("submit", (e) => {
      e.preventDefault();
      this.find(byId<HTMLInputElement>("find").value);
    });
    window.addEventListener("hashchange", () => this.readHash());
    byId("keys").append(...KEYS.map(([keys, what]) => make("tr", {}, make("td", {}, ...keys.flatMap((k) => [make("kbd", {}, k), " "])), make("td", {}, what))));
  }

  private run(command: Command): void {
    const { state: s, viewer, t, data } = this;
    const step = (x: number, by: number, low: number, high: number) => Math.min(high, Math.max(low, Math.round((x + by) * 1000) / 1000));
    const next = <T>(list: readonly T[], now: T) => list[(list.indexOf(now) + 1) % list.length];
    const shown = s.shown ?? data.hexes;
    const grow = (n: number) => this.update({ shown: n >= data.hexes ? null : Math.max(0, n) });
    switch (command) {
      case "left": return viewer.turn(-0.12, 0);
      case "right": return viewer.turn(0.12, 0);
      case "up": return viewer.turn(0, 0.12);
      case "down": return viewer.turn(0, -0.12);
      case "moveLeft": return viewer.move(0.1, 0);
      case "moveRight": return viewer.move(-0.1, 0);
      case "moveUp": return viewer.move(0, -0.1);
      case "moveDown": return viewer.move(0, 0.1);
      case "nearer": return viewer.zoom(1 / 1.15);
      case "farther": return viewer.zoom(1.15);
      case "fit": return viewer.fit();
      case "alongX": return viewer.lookAlong(0);
      case "alongY": return viewer.lookAlong(1);
      case "alongZ": return viewer.lookAlong(2);
      case "reset":
        this.stop();
        this.update({ ...structuredClone(this.first), theme: s.theme });
        return viewer.home();
      case "smaller": return this.update({ shrink: step(s.shrink, -0.05, 0.1, 1) });
      case "larger": return this.update({ shrink: step(s.shrink, 0.05, 0.1, 1) });
      case "explode": return this.update({ explode: s.explode > 0 ? 0 : 0.6 });
      case "cutMore": return this.update({ cut: step(s.cut, 0.05, 0, 1) });
      case "cutLess": return this.update({ cut: step(s.cut, -0.05, 0, 1) });
      case "flip": return this.update({ flip: !s.flip });
      case "peelMore": return this.update({ peel: Math.min(t.layers - 1, s.peel + 1) });
      case "peelLess": return this.update({ peel: Math.max(0, s.peel - 1) });
      case "colour": return this.update({ colour: next(["plain", ...(data.values ? ["value" as const] : []), ...(data.groups ? ["group" as const] : []), "layer", "order"] as const, s.colour) });
      case "boundary": return this.update({ boundary: next(["edges", "glass", "xray", "none"] as const, s.boundary) });
      case "singular": return this.update({ singular: next(["none", "inside", "all"] as const, s.singular) });
      case "sheetNext":
      case "sheetBack": {
        const n = t.sheets.length;
        const now = typeof s.sheet === "number" ? s.sheet : command === "sheetNext" ? -1 : n;
        const sheet = now + (command === "sheetNext" ? 1 : -1);
        return this.update({ sheet: sheet < 0 || sheet >= n ? null : sheet, column: null });
      }
      case "play": return this.playing ? this.stop() : this.play();
      case "back": return grow(shown - 1);
      case "forth": return grow(shown + 1);
      case "hide":
        if (s.picked !== null) this.update({ hidden: [...s.hidden, s.picked], picked: null });
        return;
      case "unhide": return this.update({ hidden: [] });
      case "unpick":
        this.marked = [];
        return this.update({ picked: null, column: null });
      case "find": return byId<HTMLInputElement>("find").select();
      case "theme": return this.update({ theme: viewer.isDark ? "light" : "dark" });
      case "panel": document.body.classList.toggle("folded"); return;
      case "link": return void this.copyLink();
      case "save": return void this.save();
      case "help": return byId<HTMLDialogElement>("help").showModal();
    }
  }

  // ---- build up

  private play(): void {
    if (this.state.shown === null) this.update({ shown: 0 });
    byId("play").textContent = "Pause";
    byId("play").setAttribute("aria-pressed", "true");
    // A mesh of any size takes some ten seconds, but a small one is not rushed through.
    const pace = Math.max(3, this.data.hexes / 12);
    let last = performance.now();
    this.played = this.state.shown ?? 0;
    const tick = (now: number) => {
      this.played += ((now - last) / 1000) * pace * Number(byId<HTMLSelectElement>("speed").value);
      last = now;
      const n = Math.floor(this.played);
      if (n >= this.data.hexes) {
        this.update({ shown: null });
        return this.stop();
      }
      if (n !== this.state.shown) this.update({ shown: n });
      this.playing = requestAnimationFrame(tick);
    };
    this.playing = requestAnimationFrame(tick);
  }

  private stop(): void {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    byId("play").textContent = "Play";
    byId("play").setAttribute("aria-pressed", "false");
  }

  // ---- hover, pick, find

  private hover(x: number, y: number): void {
    const facet = this.viewer.facetAt(x, y);
    const tip = byId("tip");
    tip.hidden = facet < 0;
    this.viewer.hover(facet < 0 ? -1 : Math.floor(facet / 6));
    if (facet < 0) return;
    const h = Math.floor(facet / 6);
    const other = this.t.glued[facet];
    const quad = facetVertices(this.t.corners, facet).map((v) => `v${v}`).join(" ");
    const lines = [`h${h}${this.valueWords(h)}`, `${other < 0 ? "boundary quad" : `towards h${Math.floor(other / 6)}`}  ${quad}${this.groupWords(facet)}`];
    tip.textContent = lines.join("\n");
    const place = (at: number, size: number, room: number) => (at + 16 + size > room ? at - 12 - size : at + 16);
    tip.style.left = `${place(x, tip.offsetWidth, this.canvas.clientWidth)}px`;
    tip.style.top = `${place(y, tip.offsetHeight, this.canvas.clientHeight)}px`;
  }

  private groupWords(facet: number): string {
    const groups = this.data.groups;
    const at = groups ? groups.facets.indexOf(facet) : -1;
    return at < 0 ? "" : `  ${groups!.names[groups!.of[at]]}`;
  }

  private valueWords(h: number): string {
    const values = this.data.values;
    return values ? `  ${values.name} ${digits(values.data[h])}` : "";
  }

  private centre(h: number): Vector3 {
    return this.viewer.placedCorners(h).reduce((sum, p) => sum.addScaledVector(p, 1 / 8), new Vector3());
  }

  private pick(h: number | null, look: boolean): void {
    if (this.state.picked === h) this.describePicked();
    this.update({ picked: h });
    if (look && h !== null && this.viewer.drawable[h]) this.viewer.lookAt(this.centre(h));
  }

  private hexButton(h: number): HTMLElement {
    return button(`h${h}`, () => this.pick(h, false), { class: "link" });
  }

  private describePicked(): void {
    const box = byId("picked");
    const h = this.state.picked;
    if (h === null) return box.replaceChildren();
    const { t } = this;
    const corners = Array.from(t.corners.subarray(8 * h, 8 * h + 8), (v) => `v${v}`).join(" ");
    const beyond: (HTMLElement | string)[] = [];
    let open = 0;
    for (let f = 6 * h; f < 6 * h + 6; f++) {
      if (t.glued[f] < 0) open++;
      else beyond.push(this.hexButton(Math.floor(t.glued[f] / 6)), " ");
    }
    const inner = Array.from({ length: 12 }, (_, i) => t.edges.ofHex[12 * h + i]).filter((e) => !t.edges.onBoundary[e]);
    const odd = inner.filter((e) => t.edges.valence[e] !== 4).length;
    const sheets = make("div", { class: "bar" }, ...this.viewer.sheetsOf(h).map((s) => button(`Sheet s${s}`, () => this.update({ sheet: s, column: null }))),
      ...this.viewer.columnsOf(h).map((c) => button(`Column ${c}`, () => this.update({ column: this.state.column === c ? null : c, sheet: null }))));
    box.replaceChildren(
      make("p", {}, make("b", {}, `h${h}`), this.valueWords(h), `  ·  layer ${t.layer[h]}  ·  ${this.data.shelling ? "shelling" : "index"} place ${this.viewer.place[h] + 1}`),
      make("p", {}, `Corners ${corners}`),
      make("p", {}, "Neighbours ", ...beyond, open ? `and ${count(open, "boundary quad")}` : ""),
      make("p", {}, `${count(inner.length, "inner edge")}, ${odd} of them singular`),
      sheets,
      make("div", { class: "bar" }, button("Centre", () => this.viewer.lookAt(this.centre(h))), button("Hide", () => this.run("hide"), { title: "Hide this hex (H)" })),
    );
  }

  private find(text: string): void {
    const box = byId("picked");
    const words = text.trim().toLowerCase();
    const complain = (why: string) => box.replaceChildren(make("p", {}, why));
    let m;
    if ((m = /^h?(\d+)$/.exec(words))) {
      const h = Number(m[1]);
      if (h >= this.data.hexes) return complain(`There is no h${h}: the last hex is h${this.data.hexes - 1}.`);
      return this.pick(h, true);
    }
    if ((m = /^v(\d+)(?:\s*[-, ]\s*v?(\d+))?$/.exec(words))) {
      const ids = [m[1], m[2]].filter((x) => x !== undefined).map(Number);
      const beyond = ids.find((v) => v >= this.data.vertices);
      if (beyond !== undefined) return complain(`There is no v${beyond}: the last vertex is v${this.data.vertices - 1}.`);
      const around = Array.from({ length: this.data.hexes }, (_, h) => h).filter((h) => {
        const c = this.t.corners.subarray(8 * h, 8 * h + 8);
        if (ids.length === 1) return c.includes(ids[0]);
        return EDGES.some(([a, b]) => (c[a] === ids[0] && c[b] === ids[1]) || (c[a] === ids[1] && c[b] === ids[0]));
      });
      const name = ids.map((v) => `v${v}`).join("-");
      if (ids.length === 2 && around.length === 0) return complain(`No hex has the edge ${name}.`);
      this.update({ picked: null });
      this.marked = ids;
      const at = ids.reduce((sum, v) => sum.addScaledVector(this.viewer.vertex(v), 1 / ids.length), new Vector3());
      if (at.toArray().every(Number.isFinite)) this.viewer.lookAt(at);
      const p = this.data.points.subarray(3 * ids[0], 3 * ids[0] + 3);
      box.replaceChildren(
        make("p", {}, make("b", {}, name), ids.length === 1 ? `  at ${Array.from(p, String).join(", ")}` : ""),
        make("p", {}, `In ${count(around.length, "hex", "hexes")}: `, ...around.slice(0, 60).flatMap((h) => [this.hexButton(h), " "]), around.length > 60 ? "..." : ""),
      );
      return;
    }
    complain("Write a hex (h12), a vertex (v5) or an edge (v5-v9).");
  }

  /** Ids beside the corners of the picked hex, or at the vertices found. */
  private labels(): void {
    const { viewer, state } = this;
    const at: [number, Vector3][] = this.marked.map((v) => [v, viewer.vertex(v)]);
    if (state.picked !== null && viewer.drawable[state.picked]) {
      viewer.placedCorners(state.picked).forEach((p, i) => at.push([this.t.corners[8 * state.picked! + i], p]));
    }
    const made = at.flatMap(([v, p]) => {
      const place = viewer.onScreen(p);
      if (!place) return [];
      const label = make("span", { class: "vertex" }, `v${v}`);
      label.style.transform = `translate(${place[0].toFixed(1)}px, ${place[1].toFixed(1)}px) translate(-50%, -50%)`;
      return [label];
    });
    byId("labels").replaceChildren(...made);
  }
}

// Last: classes must be defined before they are used.
try {
  start();
} catch (error) {
  fail(error);
}
