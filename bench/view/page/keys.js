// Everything by keyboard: one table for what the keys do and for the help that lists them.

const STEP = Math.PI / 36;  // of turning

export const VIEWS = [["+x", [1, 0, 0]], ["−x", [-1, 0, 0]], ["+y", [0, 1, 0]], ["−y", [0, -1, 0]], ["+z", [0, 0, 1]], ["−z", [0, 0, -1]]];

export function keyTable({ transport, stage, help }) {
  return [
    { keys: [" ", "k"], shown: "Space", about: "play, pause", act: () => transport.toggle() },
    { keys: [",", "ArrowLeft"], shown: ", ←", about: "one frame back", act: (e) => transport.step(e.shiftKey ? -10 : -1) },
    { keys: [".", "ArrowRight"], shown: ". →", about: "one frame on; with shift and an arrow ten", act: (e) => transport.step(e.shiftKey ? 10 : 1) },
    { keys: ["Home"], shown: "Home", about: "to the start", act: () => transport.seek(transport.start) },
    { keys: ["End"], shown: "End", about: "to the end", act: () => transport.seek(transport.end) },
    { keys: ["["], shown: "[", about: "slower", act: () => transport.faster(-1) },
    { keys: ["]"], shown: "]", about: "faster", act: () => transport.faster(1) },
    ...VIEWS.map(([name, direction], k) => ({ keys: [String(k + 1)], shown: String(k + 1), about: `view from ${name}`, act: () => stage.look(direction) })),
    { keys: ["0", "r"], shown: "0 r", about: "the view from the start", act: () => stage.look(stage.home) },
    { keys: ["+", "="], shown: "+", about: "nearer", act: () => stage.zoom(1 / 1.1) },
    { keys: ["-", "_"], shown: "−", about: "farther", act: () => stage.zoom(1.1) },
    { keys: ["?"], shown: "?", about: "this list; Esc closes it", act: help },
  ];
}

const IN_PICTURE = { shown: "arrows", about: "in the picture: turn it; with shift: move it" };

function inPicture(stage, event) {
  const [right, above] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ?? [];
  if (right === undefined) return false;
  if (event.shiftKey) stage.move(0.04 * right, 0.04 * above);
  else stage.turn(STEP * right, -STEP * above);
  return true;
}

export function listen(app) {
  const table = keyTable(app);
  const body = document.querySelector("#keys tbody");
  for (const { shown, about } of [...table, IN_PICTURE]) {
    const row = body.insertRow(), key = document.createElement("kbd");
    key.textContent = shown;
    row.insertCell().append(key);
    row.insertCell().textContent = about;
  }
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented || document.querySelector("dialog[open]")) return;
    const target = event.target, tag = target.tagName;
    if (tag === "SELECT" || (tag === "INPUT" && target.type === "range" && /^(Arrow|Page|Home|End)/.test(event.key))) return;
    if (event.key === " " && (tag === "BUTTON" || tag === "SUMMARY" || (tag === "INPUT" && target.type === "checkbox"))) return;
    if (tag === "UL" && /^(Arrow|Home|End)/.test(event.key)) return;  // it scrolls
    if (target.id === "canvas" && inPicture(app.stage, event)) return event.preventDefault();
    const entry = table.find((one) => one.keys.includes(event.key));
    if (!entry) return;
    event.preventDefault();
    entry.act(event);
  });
}
