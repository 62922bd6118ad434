// Runs inside a page with a mesh (drive.mjs --exercise): asserts what a user sees, through the same events a user makes.
(async () => {
  let checks = 0;
  const $ = (id) => document.getElementById(id);
  const check = (ok, what) => {
    checks++;
    if (!ok) throw new Error(what);
  };
  const wait = (ms = 60) => new Promise((done) => setTimeout(done, ms));
  /** Waits for what takes a frame or two, longer on a busy machine. */
  const until = async (test, what) => {
    for (let i = 0; i < 200 && !test(); i++) await wait(50);
    check(test(), what());
  };
  const key = async (k, more = {}) => {
    document.activeElement?.blur();
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key: k, bubbles: true, cancelable: true, ...more }));
    await wait(20);
  };
  const set = async (id, value, event = "input") => {
    $(id).value = value;
    $(id).dispatchEvent(new Event(event, { bubbles: true }));
    await wait(20);
  };
  const shown = () => {
    const m = /^([\d,]+) of/.exec($("status").textContent);
    return m ? Number(m[1].replace(/,/g, "")) : hexes;
  };
  const data = JSON.parse($("data").textContent);
  const hexes = data.hexes;
  const find = async (text) => {
    $("find").value = text;
    $("find-form").requestSubmit();
    await wait();
    return $("picked").textContent;
  };
  check(document.body.classList.contains("ready"), "started: " + $("why").textContent);
  check(getComputedStyle($("fallback")).display === "none", "the still picture is hidden");
  check($("title").textContent === data.title && document.title === data.title.replace(/\s+/g, " ").trim(), "title");

  // Opens cut where there is an inside; Reset shows the whole.
  if (Number($("peel").max) > 0) check($("cut").value === "0.5" && shown() < hexes, "opens cut");
  await key("0");

  // Every hex is there, and a cut, a peel, a limit and the build-up each remove some.
  check(shown() === hexes, "all shown at first");
  await set("cut", 0.5);
  const cut = shown();
  check(cut > 0 && cut < hexes, `cut shows ${cut}`);
  await key("x");
  check(shown() > 0 && shown() < hexes, "flip");
  await key("0");
  check(shown() === hexes, "reset");
  if (Number($("peel").max) > 0) {
    await key("l");
    check(shown() < hexes, "peel");
    await key("L");
    check(shown() === hexes, "unpeel");
  }
  if (data.values) {
    await set("limit", 0.3);
    check(shown() > 0 && shown() <= hexes, "limit");
    await set("limit", 1);
    check($("histogram").querySelectorAll("rect").length === 30, "histogram");
    if (!$("scale-row").hidden) {
      const ticks = () => document.querySelector("#legends .ticks").textContent;
      const fixed = ticks();
      $("scale-range").click();
      await wait(20);
      check(ticks() !== fixed && $("scale-range").ariaPressed === "true", "the scale of the values that occur");
      $("scale-fixed").click();
      await wait(20);
      check(ticks() === fixed, "and back");
    }
  }
  await key(",");
  check(shown() === hexes - 1, "one hex back");
  await key(".");
  check(shown() === hexes, "one hex further");
  await key(" ");
  await until(() => shown() > 0, () => "playing");
  await key(" ");
  await key("0");

  // Sheets cover each hex three times.
  const lengths = [...$("sheet").options].map((o) => / (\d[\d,]*) quad/.exec(o.text)).filter(Boolean).map((m) => Number(m[1].replace(/,/g, "")));
  check(lengths.reduce((a, b) => a + b, 0) === 3 * hexes, "sheet quads add up to three a hex");
  await key("n");
  check($("sheet").value === "0" && shown() <= lengths[0], "first sheet");
  await set("sheet-as", "surface", "change");
  await set("sheet", "all", "change");
  await set("chord", "all", "change");
  await set("singular", "all", "change");
  check($("legends").textContent.includes("valence"), "valence legend");
  await key("0");
  for (const k of ["b", "b", "b", "b", "g", "g", "g", "v", "v", "v", "v", "[", "]", "e", "e", "k", "j", "1", "2", "3", "f", "t", "t", "p", "p", "+", "-", "N", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]) await key(k);
  for (const k of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]) await key(k, { shiftKey: true });
  await key("0");

  // The link, the picture and the list of keys.
  await key("c");
  await until(() => $("status").textContent === "Link copied" || $("link-text").value.includes("#cam="), () => "a link to copy");
  $("link-dialog").close();
  await key("s");
  await wait(200);
  await key("?");
  check($("help").open && $("keys").rows.length > 10, "the list of keys");
  $("help").close();

  // Picking: the middle of the canvas is on the mesh.
  const canvas = $("canvas");
  const at = { offsetX: 0, clientX: canvas.clientWidth / 2, clientY: canvas.clientHeight / 2, bubbles: true, button: 0, pointerId: 1 };
  canvas.dispatchEvent(new PointerEvent("pointermove", { ...at, buttons: 0 }));
  await until(() => !$("tip").hidden && /^h\d+/.test($("tip").textContent), () => "hover names a hex");
  canvas.dispatchEvent(new PointerEvent("pointerdown", at));
  canvas.dispatchEvent(new PointerEvent("pointerup", at));
  await until(() => $("picked").textContent.startsWith($("tip").textContent.match(/^h\d+/)[0]), () => "click picks what hover named");
  await until(() => $("labels").children.length === 8, () => "eight corner labels");
  $("panel").scrollTop = 0;
  const [inside, outside] = [$("picked").getBoundingClientRect(), $("panel").getBoundingClientRect()];
  check(inside.top > outside.top && inside.top < outside.bottom - 20, "what was picked is in sight without scrolling");
  await key("h");
  check(shown() === hexes - 1, "hide");
  await key("H");
  check(shown() === hexes, "unhide");
  check((await find(`h${hexes - 1}`)).startsWith(`h${hexes - 1}`), "find a hex");
  check((await find(`h${hexes}`)).startsWith("There is no"), "find complains");
  const corner = Number(/Corners v(\d+)/.exec((await find("0")))[1]);
  check((await find(`v${corner}`)).includes("h0"), "find a vertex");
  check((await find("nonsense")).startsWith("Write"), "find explains");

  // A link brings everything back.
  await find("h0");
  await set("cut", 0.35);
  await set("shrink", 0.8);
  await until(() => ["cam=", "cut=0.35", "shrink=0.8", "picked=0"].every((w) => location.hash.includes(w)), () => `the address follows: ${location.hash}`);
  const link = location.hash;
  const before = [shown(), $("shrink").value];
  const same = () => shown() === before[0] && $("shrink").value === before[1];
  await key("0");
  await key("Escape");
  await until(() => location.hash !== link, () => "the address follows a reset");
  location.hash = link;
  await until(same, () => `the link restores ${before}, got ${shown()},${$("shrink").value}`);
  location.hash = "#cam=1,2&cut=nonsense&sheet=99999&picked=-1&shrink=1e9&hidden=%3Cscript%3E&%";
  await until(() => shown() === hexes && $("shrink").value === "1", () => "a broken link shows the start");
  location.hash = link;
  await until(same, () => "and the link still works");
  return `passed ${checks} checks`;
})();
