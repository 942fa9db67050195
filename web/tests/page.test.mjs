// The built page in Chromium, as a user meets it: drag a slider, see the number change, and the same numbers by the crate.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { preview } from "vite";

const root = fileURLToPath(new URL("..", import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "continuum-web-"));
let server, browser, page;
const complaints = [];

function file(name, text) {
  const path = join(folder, name);
  writeFileSync(path, text);
  return path;
}

/** What the crate answers without a browser. */
function answer(...what) {
  const arguments_ = ["run", "--quiet", "--release", "--bin", "answer", "--", ...what];
  const env = { ...process.env, CARGO_TARGET_DIR: join(root, "target/engine") };
  const out = execFileSync("cargo", arguments_, { cwd: join(root, "engine"), env, encoding: "utf8" });
  return out.trim().split("\n").map(Number);
}

/** Waits until an element has this text. */
async function shows(id, expected) {
  const has = ([id, source]) => new RegExp(source).test(document.getElementById(id).textContent);
  await page.waitForFunction(has, [id, expected.source], { timeout: 10_000 }).catch(() => {});
  assert.match(await text(id), expected);
}

/** Waits until the least distance is shown, in millimetres. */
const answers = (distance) => shows("answer", new RegExp(`^${distance.toFixed(3).replace(".", "\\.")} mm$`));

/** No number, plot or robot of an earlier answer is left. */
async function refuses(message) {
  await shows("message", message);
  assert.equal(await text("answer"), "No answer");
  assert.equal(await page.$eval("#answer", (answer) => answer.dataset.distances), undefined);
  for (const id of ["verdict", "details", "plot"]) assert.equal(await text(id), "");
  assert.ok(await page.isDisabled("#report") && await page.isDisabled("#proof"));
}

const distances = () => page.$eval("#answer", (answer) => JSON.parse(answer.dataset.distances));
const text = (id) => page.textContent(`#${id}`);

before(async () => {
  server = await preview({ root, preview: { port: 0 } });
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
      "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  await page.goto(server.resolvedUrls.local[0]);
  await page.waitForSelector("body[data-ready]", { timeout: 60_000 });
});

after(async () => {
  await browser?.close();
  await server?.close();
});

/** The sliders' values as the engine takes them. */
async function joints() {
  const values = await page.$$eval("#joints input", (inputs) => inputs.map((input) => Number(input.value)));
  return values.map((value, k) => (k < 3 ? value : (value * Math.PI) / 180)).join(",");
}

/** The ventricle is grown by the sines of the machine, so its walls agree to nearly all digits only. */
function assertNear(found, expected) {
  assert.equal(found.length, expected.length);
  found.forEach((distance, k) => assert.ok(Math.abs(distance - expected[k]) < 1e-9, `${distance} is not ${expected[k]}`));
}

test("the page shows the robot in the ventricle, as far from the wall as the crate says", async () => {
  assertNear(await distances(), answer(await joints()));
  const found = await distances();
  assert.equal(found.length, 30);
  const closest = found.indexOf(Math.min(...found));
  assert.match(
    await text("details"),
    new RegExp(`^Link ${closest} of 30, counted from 0 at the base, is closest, [\\d.]+ mm along the robot\\.$`),
  );
});

test("a slider moves the robot, by keyboard and by mouse", async () => {
  const seen = new Set([String(await distances())]);
  await page.focus("#inner-tube-out");
  for (let k = 0; k < 20; k += 1) await page.keyboard.press("ArrowRight");
  seen.add(String(await distances()));
  const { x, y, width, height } = await (await page.$("#outer-tube-turned")).boundingBox();
  await page.mouse.move(x + width * 0.42, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width * 0.9, y + height / 2, { steps: 5 });
  await page.mouse.up();
  seen.add(String(await distances()));
  assert.equal(seen.size, 3);
  assertNear(await distances(), answer(await joints()));
});

test("the page answers as the crate does, to the last digit", async () => {
  const [wall, line] = ["wall.stl", "shape.csv"].map((name) => join(root, "../examples/data", name));
  const expected = answer(line, wall);
  assert.equal(expected.length, 30);
  await page.setInputFiles("#wall-file", wall);
  await page.setInputFiles("#robot-file", line);
  const shown = (expected) => document.querySelector("#answer").dataset.distances === JSON.stringify(expected);
  await page.waitForFunction(shown, expected, { timeout: 10_000 }).catch(() => {});
  assert.deepEqual(await distances(), expected);
});

/** A cube from 0 to a size, as OBJ; and a face without area. */
const cube = (size) => "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n".replaceAll("1", size)
  + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\nf 1 1 2\n";
/** A robot whose base is 20 from the cube of 60. */
const LINE = "x,y,z,radius\n30,30,20,2\n30,30,30,1\n30,30,40\n";

test("a wall and a robot from files, and what was left out", async () => {
  const [wall, line] = [file("cube.obj", cube(60)), file("line.csv", LINE)];
  await page.setInputFiles("#wall-file", wall);
  await page.setInputFiles("#robot-file", line);
  // The upper link ends 20 below the top, the lower one begins 20 above the bottom.
  await answers(20);
  assert.deepEqual(await distances(), answer(line, wall));
  assert.match(await text("doubts"), /left out of cube\.obj: 1 faces without area/);
  assert.match(await text("wall-text"), /12 triangles from \(0\.0, 0\.0, 0\.0\) to \(60\.0, 60\.0, 60\.0\); frame not stated/);
});

test("the verdict is by the margin", async () => {
  await page.fill("#margin", "20");
  assert.equal(await text("verdict"), "Margin of 20 mm not kept: 2 links are within it.");
  await page.fill("#margin", "19.9");
  assert.equal(await text("verdict"), "Margin of 19.9 mm kept.");
});

test("the plot has a bar for each link, red within the margin", async () => {
  const line = "x,y,z,radius\n30,30,20,2\n30,30,30,2\n30,30,55\n";
  await page.setInputFiles("#robot-file", file("up.csv", line));
  await answers(5);
  await page.fill("#margin", "10");
  const fills = () => page.$$eval("#plot .links rect", (bars) => bars.map((bar) => bar.getAttribute("fill")));
  assert.equal((await fills()).length, 2);
  const [far, near] = await fills();
  const [red, green, blue] = near.match(/\d+/g).map(Number);
  assert.ok(red > 200 && green < 40 && blue < 40, near);
  assert.notEqual(far, near);
  // The second link is 2.5 times as long as the first.
  const widths = await page.$$eval("#plot .links rect", (bars) => bars.map((bar) => bar.getBoundingClientRect().width));
  assert.ok(Math.abs(widths[1] / widths[0] - 2.5) < 0.1, `${widths}`);
  await page.fill("#margin", "4");
  assert.equal((await fills())[1] === near, false);
});

/** Counts the pixels of the picture of which this is true, and the size of their box. */
async function pixels(condition) {
  const { x, y, width, height } = await (await page.$("#scene")).boundingBox();
  const shot = await page.screenshot({ clip: { x, y, width, height } });
  return page.evaluate(async ([data, source]) => {
    const picture = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    const pen = canvas.getContext("2d");
    pen.drawImage(picture, 0, 0);
    const { data: values } = pen.getImageData(0, 0, picture.width, picture.height);
    const is = new Function("r", "g", "b", `return ${source}`);
    let [count, left, right, top, bottom] = [0, Infinity, -Infinity, Infinity, -Infinity];
    for (let at = 0; at < values.length; at += 4) {
      if (!is(values[at], values[at + 1], values[at + 2])) continue;
      const [x, y] = [(at / 4) % picture.width, Math.floor(at / 4 / picture.width)];
      count += 1;
      [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
    }
    return { count, size: count === 0 ? 0 : Math.hypot(right - left, bottom - top) };
  }, [shot.toString("base64"), condition]);
}

test("red links are red in the picture, and the closest pair can be seen", async () => {
  const red = "r > 140 && g < 70 && b < 70";
  await page.fill("#margin", "4");
  assert.equal((await pixels(red)).count, 0);
  await page.fill("#margin", "10");
  assert.ok((await pixels(red)).count > 100);
  // The pair is the only thing that is black.
  const black = "r + g + b === 0";
  const before = await pixels(black);
  assert.ok(before.count > 20, `${before.count}`);
  await page.click("#closest");
  const after = await pixels(black);
  assert.ok(after.size > 40 && after.size > 1.5 * before.size, `${before.size} ${after.size}`);
});

test("a refused input leaves no stale answer", async () => {
  await page.setInputFiles("#robot-file", file("bare.csv", "30,30,20\n30,30,40\n"));
  await refuses(/bare\.csv has no radius; enter one/);
  await page.fill("#radius", "2");
  await answers(20);
  await page.fill("#radius", "-1");
  await refuses(/The radius is -1; enter a number that is at least 0/);
  await page.fill("#radius", "");
  await refuses(/bare\.csv has no radius/);
  await page.fill("#radius", "0");
  await answers(20);
  for (const [field, bad, good] of [["margin", "", "1"], ["margin", "-1", "1"], ["robot-scale", "0", "1"], ["wall-scale", "", "1"]]) {
    await page.fill(`#${field}`, bad);
    await refuses(bad ? new RegExp(`is ${bad}; enter a number`) : /is empty; enter a number/);
    await page.fill(`#${field}`, good);
    await answers(20);
  }
  await page.setInputFiles("#wall-file", file("broken.stl", "no mesh"));
  await refuses(/broken\.stl is not a valid STL file/);
  await page.setInputFiles("#wall-file", file("cube.obj", cube(60)));
  await answers(20);
  await page.setInputFiles("#robot-file", file("bad.csv", "1,2,3\n1,two,3\n"));
  await refuses(/line 2 of bad\.csv has 'two' in column 2/);
});

test("a CSV is read by the rules of the command", async () => {
  await page.fill("#radius", "");
  // Decimal commas; the radius is the column that the heading names.
  const german = "x;y;z;temperatur;radius\n30,0;30,0;20,5;37;2\n30,0;30,0;39,5;37;2\n";
  await page.setInputFiles("#robot-file", file("german.csv", german));
  await answers(20.5);
  await page.fill("#radius", "1");
  await refuses(/german\.csv has a column of radii; leave the radius empty/);
  await page.fill("#radius", "");
  await answers(20.5);
});

test("joints do not move the robot of a file, and do not drop it", async () => {
  assert.ok(await page.isDisabled("#inner-tube-out"));
  assert.match(await text("robot-text"), /The robot is german\.csv/);
  await page.click("#reset-robot");
  assert.ok(await page.isEnabled("#inner-tube-out"));
  assert.equal((await distances()).length, 30);
});

test("a wrong unit is doubted, and the scale helps", async () => {
  const metres = "x,y,z,radius\n0.03,0.03,0.02,0.002\n0.03,0.03,0.04,0.002\n";
  await page.setInputFiles("#robot-file", file("metres.csv", metres));
  await shows("doubts", /the robot's box measures 0\.02\d, the mesh's 103\.923; with the robot's scale 1000 they fit/);
  await page.fill("#robot-scale", "1000");
  await answers(20);
  assert.doesNotMatch(await text("doubts"), /measures/);
  await page.setInputFiles("#robot-file", file("thick.csv", "30,30,20,2000\n30,30,40,2000\n"));
  await shows("doubts", /the radius 2000 is large beside the mesh's box, which measures 103\.923; check its unit: a radius in the file 0\.001 times/);
  await page.setInputFiles("#robot-file", file("metres.csv", metres));
  await page.fill("#robot-scale", "1000");
  await answers(20);
  await page.setInputFiles("#wall-file", file("metres.obj", cube("0.06")));
  await shows("wall-text", /to \(0\.1, 0\.1, 0\.1\)/);
  await page.fill("#wall-scale", "1000");
  await answers(20);
});

test("a pose places the robot", async () => {
  await page.fill("#pose", "1 0 0 0\n0 1 0 0\n0 0 1 -5\n0 0 0 1\n");
  await answers(15);
  assert.match(await text("details"), /placed by the pose/);
  await page.selectOption("#robot-frame", "RAS");
  await refuses(/the pose brings the robot into the wall's frame already; leave the robot's frame at 'not stated'/);
  await page.selectOption("#robot-frame", "");
  await page.fill("#pose", "1 0 0 0");
  await refuses(/the pose has 1 lines; write 4 lines of 4 numbers/);
  await page.fill("#pose", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1");
  await refuses(/the pose: .*scale/);
  await page.fill("#pose", "");
  await answers(20);
});

test("markups state their frame, and the robot is turned into the wall's", async () => {
  await page.setInputFiles("#wall-file", file("cube.obj", cube(60)));
  const curve = (type) => JSON.stringify({
    markups: [{ type, coordinateSystem: "LPS", coordinateUnits: "mm",
      controlPoints: [
        ...[[-30, -30, 20], [-30, -30, 40]].map((position) => ({ position, positionStatus: "defined" })),
        { position: [0, 0, 0], positionStatus: "undefined" },
      ] }],
  });
  await page.setInputFiles("#robot-file", file("curve.mrk.json", curve("Curve")));
  await page.fill("#radius", "1");
  await refuses(/the robot is in LPS, but cube\.obj does not say whether it is RAS or LPS; choose the wall's frame/);
  await page.selectOption("#wall-frame", "RAS");
  await answers(20);
  assert.match(await text("details"), /The robot is turned from LPS to RAS/);
  assert.match(await text("doubts"), /left out of curve\.mrk\.json: 1 points without a position/);
  assert.equal(await page.$eval("#robot-frame", (select) => select.selectedOptions[0].text), "LPS, stated by the file");
  assert.ok(await page.isDisabled("#robot-frame"));
  await page.selectOption("#wall-frame", "LPS");
  // (-30, -30, 20 to 40) is 30 from two faces at a right angle: sqrt(2) 30 less the radius.
  await answers(Math.SQRT2 * 30 - 1);
  assert.match(await text("doubts"), /do not overlap/);
  await page.setInputFiles("#robot-file", file("list.mrk.json", curve("Fiducial")));
  await refuses(/type Fiducial, which is no curve/);
  await page.selectOption("#line", "0");
  await answers(Math.SQRT2 * 30 - 1);
});

test("the frame of a robot can be chosen, and a doubt says when", async () => {
  await page.fill("#radius", "");
  await page.setInputFiles("#robot-file", file("turned.csv", "-30,-30,20,1\n-30,-30,40,1\n"));
  await shows("doubts", /do not overlap; they are 30\.000 apart; with the robot's frame RAS they fit/);
  await page.selectOption("#robot-frame", "RAS");
  await answers(20);
  assert.equal(await text("doubts"), "left out of cube.obj: 1 faces without area");
});

test("a VTK file with several lines asks for one", async () => {
  const centred = (_, xyz) => `v ${xyz.split(" ").map((x) => Number(x) - 100).join(" ")}`;
  const far = cube(200).replaceAll(/^v (.*)$/gm, centred);
  await page.setInputFiles("#wall-file", file("far.obj", far));
  await page.setInputFiles("#robot-file", join(root, "../crates/mesh-files/tests/data/lines_ascii.vtp"));
  await page.fill("#radius", "0");
  await refuses(/lines_ascii\.vtp holds 2 lines; choose one from 0 to 1/);
  await page.selectOption("#line", { label: "index 1" });
  // Its highest point is (0, 0, 9) (`tests/data/make.py`).
  await answers(91);
  await page.selectOption("#line", { label: "index 0" });
  // (3, 9 / 4, -1 / 2) is the point with the largest coordinate.
  await answers(97);
});

/** Voxels of 1 mm: label 1 below z = 10, label 2 from there on. */
const nrrd = (position) => `NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 20\n${position}encoding: ascii\n\n`
  + Array.from({ length: 8 * 8 * 20 }, (_, k) => (k < 8 * 8 * 10 ? 1 : 2)).join(" ") + "\n";
const PLACED = "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
  + "space units: \"mm\" \"mm\" \"mm\"\n";

test("the labels of a segmentation can be chosen", async () => {
  await page.fill("#radius", "");
  await page.setInputFiles("#robot-file", file("line.csv", LINE));
  await page.setInputFiles("#wall-file", file("two.nrrd", nrrd(PLACED)));
  await shows("doubts", /two\.nrrd has 2 labels, read as one surface; choose a label/);
  const low = async () => Number((await text("wall-text")).match(/from \([-\d.]+, [-\d.]+, ([-\d.]+)\)/)[1]);
  assert.ok(await low() <= 0);
  await page.selectOption("#label", "2");
  // The surface is between the centres of the voxels at 9 and 10.
  await page.waitForFunction(() => !/labels/.test(document.querySelector("#doubts").textContent));
  assert.ok(await low() >= 9 && await low() <= 10, await text("wall-text"));
  assert.match(await text("wall-text"), /frame LPS; unit mm/);
  assert.ok(await page.isDisabled("#wall-frame"));
});

test("a segmentation without a position needs a choice", async () => {
  await page.setInputFiles("#wall-file", file("nowhere.nrrd", nrrd("spacings: 1 1 1\n")));
  await refuses(/nowhere\.nrrd does not say where its voxels are .*tick 'Place the first voxel at the origin'/);
  await page.check("#no-position");
  await shows("wall-text", /^nowhere\.nrrd: \d+ triangles/);
});

test("header and voxels in two files are chosen together", async () => {
  const [header, voxels] = ["ball.mhd", "ball.raw"].map((name) => join(root, "../crates/mesh-files/tests/data", name));
  await page.setInputFiles("#wall-file", header);
  await refuses(/ball\.raw is missing; choose it together with its header/);
  await page.setInputFiles("#wall-file", [voxels, header]);
  await shows("wall-text", /^ball\.mhd: \d+ triangles/);
});

test("a dropped file is read like a chosen one, by what it holds", async () => {
  await page.setInputFiles("#wall-file", file("cube.obj", cube(60)));
  const drop = (name, text) => page.evaluate(([name, text]) => {
    const data = new DataTransfer();
    data.items.add(new File([text], name));
    window.dispatchEvent(new DragEvent("drop", { dataTransfer: data }));
  }, [name, text]);
  await drop("beside.csv", "x,y,z,radius\n70,30,20,1\n70,30,40\n");
  await answers(9);
  assert.match(await text("doubts"), /base is outside the wall/);
  assert.match(await text("verdict"), /^Margin of [\d.]+ mm kept, but the robot's base is outside the wall\.$/);
  assert.equal(await page.getAttribute("#verdict", "class"), "");
  const vtk = (points, cells) =>
    `# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS ${points.length} float\n${points.join("\n")}\n${cells}\n`;
  await drop("line.vtk", vtk(["30 30 20", "30 30 40"], "LINES 1 3\n2 0 1"));
  await page.fill("#radius", "1");
  await answers(20);
  await drop("floor.vtk", vtk(["-99 -99 5", "99 -99 5", "0 200 5"], "POLYGONS 1 4\n3 0 1 2"));
  await answers(15);
});

test("a robot that leaves through an opening is not green", async () => {
  // The cube without its last square, x = 60.
  const open = cube(60).split("\n").filter((line) => !/^f 2 4 8 6\b/.test(line)).join("\n");
  assert.notEqual(open, cube(60));
  await page.setInputFiles("#wall-file", file("open.obj", open));
  await page.fill("#radius", "");
  await page.setInputFiles("#robot-file", file("leaves.csv", "x,y,z,radius\n30,30,30,1\n50,30,30,1\n70,30,30,1\n130,30,30,1\n"));
  await shows("doubts", /open\.obj: the mesh is open: one opening 84\.85 wide at \(60, 30, 30\)/);
  await page.fill("#margin", "2");
  assert.match(await text("verdict"), /^Margin of 2 mm kept, but 2 links are not inside the wall\.$/);
  assert.equal(await page.getAttribute("#verdict", "class"), "");
  assert.match(await text("doubts"), /The robot's base is inside the wall, but 2 links are not inside the wall \(its tip: outside\)/);
  await page.setInputFiles("#wall-file", file("cube.obj", cube(60)));
});

test("the answer stays in view at 1280 x 800 whatever has the focus", async () => {
  const inView = (id) => page.$eval(`#${id}`, (element) => {
    const { top, bottom, height } = element.getBoundingClientRect();
    const seen = document.elementFromPoint(element.getBoundingClientRect().left + 2, (top + bottom) / 2);
    return height > 0 && top >= 0 && bottom <= innerHeight && (seen === element || element.contains(seen));
  });
  for (const id of ["no-position", "checker", "pose", "margin"]) {
    await page.focus(`#${id}`);
    await page.$eval(`#${id}`, (element) => element.scrollIntoView());
    assert.ok(await inView("answer") && await inView("verdict") && await inView("details"), id);
    assert.equal(await page.evaluate(() => scrollY), 0);
  }
  await page.focus("#pose");
  await page.fill("#pose", "1 2 3");
  await refuses(/line 1 of the pose has 3 columns; write 4 numbers/);
  assert.ok(await inView("message"));
  await page.fill("#pose", "");
});

/** What a click downloads. */
async function downloaded(id) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`#${id}`)]);
  const path = join(folder, download.suggestedFilename());
  await download.saveAs(path);
  return path;
}

test("the report has the inputs and all digits", async () => {
  await page.fill("#radius", "");
  await page.setInputFiles("#wall-file", file("cube.obj", cube(60)));
  await page.setInputFiles("#robot-file", file("line.csv", LINE));
  await answers(20);
  await page.fill("#margin", "21");
  const report = JSON.parse(readFileSync(await downloaded("report"), "utf8"));
  assert.equal(report.keeps_margin, false);
  const { margin, wall, robot } = report.inputs;
  assert.deepEqual([margin, wall, robot], [
    21,
    { file: "cube.obj", label: null, scale: 1, frame: null },
    { file: "line.csv", line: null, scale: 1, radius: null, frame: null, pose: null },
  ]);
  assert.deepEqual(report.links.map((link) => link.distance), await distances());
  assert.deepEqual([report.minimum.distance, report.minimum.link, report.base], [20, 0, "inside"]);
  assert.deepEqual(report.mesh.bounds, [[0, 0, 0], [60, 60, 60]]);
  assert.deepEqual(report.warnings, ["left out of cube.obj: 1 faces without area"]);
});

test("the proof passes the program that checks it", async () => {
  await page.click("#proof");
  await shows("proof-text", /There is no proof: the robot does not keep the margin/);
  await page.fill("#margin", "19");
  const files = [await downloaded("checker"), await downloaded("wall-obj"), await downloaded("proof")];
  const said = execFileSync("python3", files, { encoding: "utf8" });
  assert.match(said, /This chain keeps more than 19\.0 from 12 triangles/);
  assert.match(said, /\nyes\n$/);
});

test("a small window shows picture and answer", async () => {
  await page.click("#reset-robot");
  await page.click("#reset-wall");
  await page.fill("#margin", "0.5");
  assert.match(await text("answer"), /^\d\.\d{3} mm$/);
  await page.setViewportSize({ width: 360, height: 640 });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 360, `${wide}`);
  assert.ok(await page.isVisible("#answer") && await page.isVisible("#scene"));
  await page.setViewportSize({ width: 1280, height: 800 });
});

test("nothing went wrong on the way, and a picture is drawn", async () => {
  assert.deepEqual(complaints, []);
  const pictures = process.env.PICTURE;
  await page.reload();
  await page.waitForSelector("body[data-ready]", { timeout: 60_000 });
  const drawn = await page.screenshot(pictures ? { path: pictures } : {});
  assert.ok(drawn.length > 20_000);
});
