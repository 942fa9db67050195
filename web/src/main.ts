import start, { Answers, Robot, Wall } from "./engine/continuum_web.js";
import { GRADIENT } from "./colours";
import { Scene } from "./scene";

/** Clearances from here on have the last colour. */
const FARTHEST = 5;

const find = <Element extends HTMLElement>(id: string) => document.getElementById(id) as Element;
const scene = new Scene(find<HTMLCanvasElement>("scene"));
const margin = find<HTMLInputElement>("margin");
const radius = find<HTMLInputElement>("radius");

let wall: Wall;
/** The user's points, if there are any. */
let points: string | undefined;
let joints: HTMLInputElement[] = [];

function say(message: string) {
  find("message").textContent = message;
}

/** What the library throws is a text that says what to change. */
function attempt<Result>(action: () => Result): Result | undefined {
  try {
    say("");
    return action();
  } catch (error) {
    say(String(error));
    return undefined;
  }
}

function robot(): Robot {
  if (points !== undefined) return Robot.from_csv(points, Number(radius.value));
  const values = joints.map((joint) => Number(joint.value));
  return Robot.of_tubes(
    Float64Array.from(values.slice(0, 3)),
    Float64Array.from(values.slice(3), (degrees) => (degrees * Math.PI) / 180),
  );
}

function update() {
  const found = attempt(() => {
    const asked = robot();
    try {
      return wall.ask(asked);
    } finally {
      asked.free();
    }
  });
  if (!found) return;
  show(found);
  found.free();
}

function show(found: Answers) {
  const limit = Number(margin.value);
  find("margin-value").textContent = `${limit.toFixed(1)} mm`;
  scene.showRobot(found, limit, FARTHEST);
  const distances = found.distances();
  const near = distances.filter((distance) => distance <= limit).length;
  const answer = find("answer");
  answer.textContent = `${found.minimum().toFixed(3)} mm`;
  answer.classList.toggle("near", near > 0);
  // All digits, for whoever compares.
  answer.dataset.distances = JSON.stringify(Array.from(distances));
  const place = `Link ${found.closest()} of ${distances.length} is closest, ${found.arc_length().toFixed(1)} mm along the robot.`;
  const base = found.base() === "inside" ? "" : ` The robot's base is ${found.base() === "outside" ? "outside the wall" : "on the wall, or the wall is open"}.`;
  const red = near === 0 ? "" : ` ${near} ${near === 1 ? "link is" : "links are"} within the margin.`;
  find("details").textContent = place + red + base;
}

function makeJoints() {
  const [longest, goal] = [Robot.longest(), Robot.goal()];
  const slider = (name: string, low: number, high: number, step: number, value: number, unit: string) => {
    const id = name.toLowerCase().replaceAll(" ", "-");
    const row = document.createElement("div");
    row.className = "joint";
    row.innerHTML = `<label for="${id}">${name}</label><input id="${id}" type="range"><output for="${id}"></output>`;
    const input = row.querySelector("input")!;
    const output = row.querySelector("output")!;
    Object.assign(input, { min: low, max: high, step, value });
    const write = () => (output.textContent = `${Number(input.value).toFixed(1)} ${unit}`);
    input.addEventListener("input", () => {
      write();
      points = undefined;
      update();
    });
    write();
    find("joints").append(row);
    return input;
  };
  const names = ["Outer tube", "Middle tube", "Inner tube"];
  joints = [
    ...names.map((name, k) => slider(`${name} out`, k === 0 ? 1 : 0, longest[k]!, 0.1, goal[k]!, "mm")),
    ...names.map((name, k) => slider(`${name} turned`, -180, 180, 1, (goal[3 + k]! * 180) / Math.PI, "°")),
  ];
}

function takeWall(next: Wall | undefined) {
  if (!next) return;
  wall?.free();
  wall = next;
  scene.showWall(wall);
  update();
}

async function take(file: File) {
  if (/\.(csv|txt)$/i.test(file.name)) {
    const before = points;
    points = await file.text();
    update();
    if (find("message").textContent) points = before;
  } else {
    const bytes = new Uint8Array(await file.arrayBuffer());
    takeWall(attempt(() => Wall.read(file.name, bytes)));
  }
}

function listen() {
  margin.addEventListener("input", update);
  radius.addEventListener("input", update);
  for (const id of ["mesh-file", "line-file"]) {
    const input = find<HTMLInputElement>(id);
    input.addEventListener("change", () => Promise.all(Array.from(input.files ?? [], take)));
  }
  find("reset").addEventListener("click", () => {
    points = undefined;
    takeWall(attempt(() => Wall.ventricle()));
  });
  addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    void Promise.all(Array.from(event.dataTransfer?.files ?? [], take));
  });
}

find("colours").style.background = GRADIENT;
find("high").textContent = `${FARTHEST} mm and more`;
await start();
makeJoints();
listen();
takeWall(attempt(() => Wall.ventricle()));
document.body.dataset.ready = "true";
