// What `drive.mjs --pair` does on a page with two meshes: turns and cuts one, and the other must follow. Evaluates to a line of text.
(async () => {
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const until = async (done) => {
    for (let i = 0; i < 200 && !done(); i++) await wait(100);
  };
  const frames = [...document.querySelectorAll("iframe")];
  const told = [null, null];
  addEventListener("message", ({ source, data }) => (told[frames.findIndex((f) => f.contentWindow === source)] = data));
  const press = (i, key) => frames[i].contentDocument.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  const cut = (i) => frames[i].contentDocument.getElementById("cut").value;
  const direction = ({ camera: c }) => [0, 1, 2].map((k) => c[k] - c[k + 3]);
  const length = (x) => Math.hypot(...x);
  press(0, "ArrowLeft");
  frames[0].contentDocument.getElementById("cut").value = "0.7";
  frames[0].contentDocument.getElementById("cut").dispatchEvent(new Event("input"));
  await until(() => cut(1) === "0.7");
  if (cut(1) !== "0.7") throw new Error(`the cut of the right one is ${cut(1)}`);
  press(1, "+");
  await until(() => told[1]);
  const [a, b] = told.map((t) => t && direction(t));
  if (!a || !b) throw new Error(`nothing told: ${JSON.stringify(told)}`);
  const turn = length(a.map((x, k) => x / length(a) - b[k] / length(b)));
  if (turn > 1e-3 || Math.abs(length(a) / length(b) - 1.15) > 1e-3) throw new Error(`cameras differ: ${a} and ${b}`);
  return "pair: the right one follows the left one, and is followed";
})()
