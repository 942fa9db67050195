// The answer is a function of the inputs: any change of an input computes all of it again, or shows why there is none.

import checker from "../../docs/book/check_proof.py?url";
import start, { Answers, Files, Robot, Wall } from "./engine/continuum_web.js";
import { GRADIENT, RED } from "./colours";
import { save } from "./downloads";
import {
  addCoordinates, chosen, fill, find, notNegative, number, optionalNumber, positive, resetCoordinates, showStatedFrame,
} from "./fields";
import { plotClearance } from "./plot";
import { Scene } from "./scene";

/** Clearances from here on have the last colour, in millimetres. A larger margin moves it. */
const FARTHEST = 5;

/** The user's files, and the name of the one to read. */
interface Chosen {
  files: Files;
  name: string;
}

/** A wall as it was read, or why it was not. */
interface Read {
  key: string;
  wall?: Wall;
  error?: unknown;
}

const scene = new Scene(find<HTMLCanvasElement>("scene"));
let joints: HTMLInputElement[] = [];
let wallFile: Chosen | undefined;
let robotFile: Chosen | undefined;
let read: Read | undefined;
/** The last answers and the margin, as long as they are of the inputs. */
let answered: { answers: Answers; margin: number; farthest: number } | undefined;

const NOT_NEGATIVE = "a number that is at least 0";
const POSITIVE = "a number greater than 0";

/** How to check a proof: what the page shows until a proof is refused. */
const PROOF_TEXT = find("proof-text").innerHTML;

function readMargin() {
  return number("margin", "The margin", notNegative, NOT_NEGATIVE);
}

/** Reads the wall, unless it is the one that was read last. */
function readWall(): Wall {
  const label = wallFile && chosen("label");
  const scale = number("wall-scale", "The wall's scale", positive, POSITIVE);
  const allowNoPosition = find<HTMLInputElement>("no-position").checked;
  const key = JSON.stringify([wallFile?.name, label, scale, allowNoPosition]);
  if (read?.key !== key) {
    forgetWall();
    try {
      const wall = wallFile
        ? Wall.read(wallFile.files, wallFile.name, label === undefined ? undefined : Number(label), scale, allowNoPosition)
        : Wall.ventricle();
      read = { key, wall };
      // A wall of one label keeps the choice.
      const labels = Array.from(wall.labels(), String);
      if (labels.length > 0) offerLabels(labels);
      scene.showWall(wall);
    } catch (error) {
      read = { key, error };
    }
  }
  if (!read?.wall) throw read?.error;
  const wall = read.wall;
  find("wall-text").textContent = "";
  showStatedFrame("wall-frame", wall.stated_frame());
  wall.choose_frame(chosen("wall-frame"));
  find("wall-text").textContent = `${wallFile?.name ?? "The ventricle"}: ${wall.describe()}.`;
  return wall;
}

function forgetWall() {
  read?.wall?.free();
  read = undefined;
  scene.hideWall();
  find("wall-text").textContent = "";
}

/** Offers these labels, if there are any. */
function offerLabels(labels: string[]) {
  fill("label", [["", "all, as one surface"], ...labels.map((label): [string, string] => [label, `label ${label}`])]);
  find("label-choice").hidden = labels.length === 0;
}

function readRobot(): Robot {
  if (!robotFile) {
    const values = joints.map((joint) => Number(joint.value));
    return Robot.of_tubes(
      Float64Array.from(values.slice(0, 3)),
      Float64Array.from(values.slice(3), (degrees) => (degrees * Math.PI) / 180),
    );
  }
  const line = chosen("line");
  const robot = Robot.read(
    robotFile.files,
    robotFile.name,
    line === undefined ? undefined : Number(line),
    number("robot-scale", "The robot's scale", positive, POSITIVE),
    optionalNumber("radius", "The radius", notNegative, NOT_NEGATIVE),
    chosen("robot-frame"),
  );
  showStatedFrame("robot-frame", robot.stated_frame());
  return robot;
}

/** Calls an action with the wall and the robot of the inputs. */
function withRobot<Result>(action: (wall: Wall, robot: Robot, pose: string) => Result): Result {
  const wall = readWall();
  const robot = readRobot();
  try {
    return action(wall, robot, find<HTMLTextAreaElement>("pose").value);
  } finally {
    robot.free();
  }
}

/** Answers for the inputs, or shows why there is no answer. */
function update() {
  clear();
  try {
    const margin = readMargin();
    withRobot((wall, robot, pose) => {
      const answers = wall.ask(robot, pose);
      answered = { answers, margin, farthest: Math.max(FARTHEST, 2 * margin) };
      const ofMargin = wall.margin_doubt(margin);
      show([...wall.notes(), ...robot.notes(), ...answers.doubts(), ...(ofMargin ? [ofMargin] : [])]);
    });
    nameRobot(true);
  } catch (error) {
    refuse(error);
    nameRobot(false);
  }
}

/** Names the robot, or the chosen file if there is no answer about it. */
function nameRobot(isAnswered: boolean) {
  const file = isAnswered ? `The robot is ${robotFile?.name}.` : `There is no answer about the file ${robotFile?.name}.`;
  find("robot-text").textContent = robotFile
    ? `${file} The joints do not move it.`
    : "The robot is made of the concentric tubes.";
}

/** Removes everything that belongs to the last answer. */
function clear() {
  answered?.answers.free();
  answered = undefined;
  const answer = find("answer");
  answer.textContent = "";
  answer.className = "";
  delete answer.dataset.distances;
  for (const id of ["verdict", "details", "message"]) find(id).textContent = "";
  find("doubts").replaceChildren();
  find("plot").replaceChildren();
  scene.hideRobot();
  enableActions(false);
  find("proof-text").classList.remove("refused");
  find("proof-text").innerHTML = PROOF_TEXT;
}

/** Shows an error instead of an answer. What the engine throws is a text that says what to change. */
function refuse(error: unknown) {
  clear();
  find("answer").textContent = "No answer";
  find("message").textContent =
    error instanceof WebAssembly.RuntimeError ? `The engine stopped (${error.message}); reload the page` : String(error);
}

function show(warnings: string[]) {
  if (!answered) return;
  const { answers, margin, farthest } = answered;
  const distances = answers.distances();
  const near = distances.filter((distance) => distance <= margin).length;
  scene.showRobot(answers, margin, farthest);
  plotClearance(find("plot"), answers, margin, farthest);
  find("high").textContent = `${farthest} mm and more`;
  const answer = find("answer");
  answer.textContent = `${answers.minimum().toFixed(3)} mm`;
  answer.className = near > 0 ? "near" : "";
  // All digits, for whoever compares.
  answer.dataset.distances = JSON.stringify(Array.from(distances));
  const base = answers.base();
  const side = base === "outside" ? "outside the wall" : "on the wall, or the wall is open";
  const links = `${near} ${near === 1 ? "link is" : "links are"} within it`;
  // Links that leave through an opening keep the margin too.
  const astray = answers.sides().filter((side) => side !== "inside").length;
  const strays = `${astray} ${astray === 1 ? "link is" : "links are"} not inside the wall`;
  const doubt = base === "inside" ? strays : `the robot's base is ${side}`;
  const kept = answers.is_inside() ? "kept." : `kept, but ${doubt}.`;
  find("verdict").textContent = `Margin of ${margin} mm ${near === 0 ? kept : `not kept: ${links}.`}`;
  // Green only if the robot is where a robot belongs.
  find("verdict").className = near > 0 ? "near" : answers.is_inside() ? "kept" : "";
  const turned = answers.turned();
  find("details").textContent = [
    `Link ${answers.closest()} of ${distances.length}, counted from 0 at the base, is closest, `
      + `${answers.arc_length().toFixed(1)} mm along the robot.`,
    ...(turned ? [`The robot is turned from ${turned}.`] : []),
    ...(find<HTMLTextAreaElement>("pose").value.trim() ? ["The robot is placed by the pose."] : []),
  ].join(" ");
  const unsigned = "distances do not say on which side the robot is.";
  const outside = base !== "inside" ? [`The robot's base is ${side}; ${unsigned}`]
    : answers.is_inside() ? [] : [`The robot's base is inside the wall, but ${strays} (its tip: ${answers.tip()}); ${unsigned}`];
  find("doubts").replaceChildren(
    ...[...warnings, ...outside].map((text) => {
      const item = document.createElement("li");
      item.textContent = text;
      return item;
    }),
  );
  enableActions(true);
}

/** Enables what needs an answer. */
function enableActions(isEnabled: boolean) {
  for (const id of ["closest", "report", "proof", "wall-obj"]) find<HTMLButtonElement>(id).disabled = !isEnabled;
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

/** Takes a wall's files, or the ventricle. Choices belong to a file, so they are reset. */
function takeWall(next?: Chosen, isFromField = false) {
  // The field names the file only if the file comes from the field.
  if (!isFromField) find<HTMLInputElement>("wall-file").value = "";
  forgetWall();
  wallFile?.files.free();
  wallFile = next;
  offerLabels([]);
  resetCoordinates("wall");
  find<HTMLInputElement>("no-position").checked = false;
}

/** Takes a robot's file, or the tubes. The joints move the tubes only. */
function takeRobot(next?: Chosen, isFromField = false) {
  if (!isFromField) find<HTMLInputElement>("robot-file").value = "";
  robotFile?.files.free();
  robotFile = next;
  const choices = next?.files.line_choices(next.name) ?? 0;
  const indices = Array.from({ length: choices }, (_, index): [string, string] => [String(index), `index ${index}`]);
  fill("line", [["", "choose one"], ...indices]);
  find("line-choice").hidden = choices === 0;
  resetCoordinates("robot");
  for (const id of ["line", "radius", "robot-scale", "robot-frame"]) {
    find<HTMLInputElement>(id).disabled = next === undefined;
  }
  find<HTMLFieldSetElement>("joints").disabled = next !== undefined;
}

/** Files are taken one after the other: the last choice is the one that stays. */
let taken = Promise.resolve();

/** Takes files as a robot, as a wall, or by what they hold. */
function take(list: File[], role?: "robot" | "wall") {
  taken = taken.then(() => readFiles(list, role));
}

async function readFiles(list: File[], role?: "robot" | "wall") {
  if (list.length === 0) return;
  clear();
  find("answer").textContent = "Reading ...";
  try {
    const contents = await Promise.all(list.map(async (file) => new Uint8Array(await file.arrayBuffer())));
    // The browser draws the line above first.
    await new Promise((resolve) => setTimeout(resolve));
    const wall: Chosen = { files: new Files(), name: "" };
    list.forEach(({ name }, k) => {
      const files = new Files();
      files.add(name, contents[k]!);
      if (role === "robot" || (role === undefined && files.holds_robot(name))) {
        takeRobot({ files, name }, role !== undefined);
      } else {
        files.free();
        wall.files.add(name, contents[k]!);
        if (!wall.name || /\.(hdr|mhd|nhdr)$/i.test(name)) wall.name = name;
      }
    });
    if (wall.name) takeWall(wall, role !== undefined);
    else wall.files.free();
    update();
  } catch (error) {
    refuse(error);
  }
}

/** Downloads the inputs and the answers. */
function saveReport() {
  if (!answered || !read?.wall) return;
  const { answers, margin } = answered;
  const value = (id: string) => find<HTMLInputElement>(id).value || null;
  const figure = (id: string) => (value(id) === null ? null : Number(value(id)));
  const robot = robotFile
    ? { file: robotFile.name, line: figure("line"), scale: figure("robot-scale"), radius: figure("radius") }
    : { joints: Object.fromEntries(joints.map((joint) => [joint.id, Number(joint.value)])) };
  const inputs = {
    wall: { file: wallFile?.name ?? "the ventricle", label: figure("label"), scale: figure("wall-scale"), frame: value("wall-frame") },
    robot: { ...robot, frame: value("robot-frame"), pose: value("pose") },
    margin,
  };
  const warnings = Array.from(find("doubts").children, (item) => item.textContent);
  const report = { inputs, keeps_margin: answers.minimum() > margin, ...JSON.parse(read.wall.report(answers)), warnings };
  save("report.json", JSON.stringify(report, undefined, 2), "application/json");
}

function saveProof() {
  const text = find("proof-text");
  try {
    const margin = readMargin();
    const proof = withRobot((wall, robot, pose) => wall.prove(robot, pose, margin));
    if (proof === undefined) throw "There is no proof: the robot does not keep the margin, or only by rounding";
    save("proof.txt", proof);
  } catch (error) {
    text.textContent = String(error);
    text.classList.add("refused");
  }
}

function listen() {
  for (const id of ["margin", "radius", "robot-scale", "wall-scale", "pose"]) find(id).addEventListener("input", update);
  for (const id of ["label", "line", "wall-frame", "robot-frame", "no-position"]) find(id).addEventListener("change", update);
  for (const role of ["robot", "wall"] as const) {
    const input = find<HTMLInputElement>(`${role}-file`);
    // The same file can be chosen again after it was changed.
    input.addEventListener("click", () => (input.value = ""));
    input.addEventListener("change", () => take(Array.from(input.files ?? []), role));
  }
  find("reset-robot").addEventListener("click", () => {
    takeRobot();
    update();
  });
  find("reset-wall").addEventListener("click", () => {
    takeWall();
    update();
  });
  find("closest").addEventListener("click", () => scene.showPair());
  find("report").addEventListener("click", saveReport);
  find("proof").addEventListener("click", saveProof);
  find("wall-obj").addEventListener("click", () => read?.wall && save("wall.obj", read.wall.obj()));
  addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    take(Array.from(event.dataTransfer?.files ?? []));
  });
  new ResizeObserver(() => {
    if (answered) plotClearance(find("plot"), answered.answers, answered.margin, answered.farthest);
  }).observe(find("view"));
}

find("colours").style.background = GRADIENT;
find("red").style.background = RED;
find<HTMLAnchorElement>("checker").href = checker;
addCoordinates("robot");
addCoordinates("wall");
await start();
makeJoints();
takeRobot();
takeWall();
listen();
update();
document.body.dataset.ready = "true";
