// The built page in Chromium, as a user meets it: drag a slider, see the number change, and the same numbers by the crate.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
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

const distances = () => page.$eval("#answer", (answer) => JSON.parse(answer.dataset.distances));
const text = (id) => page.textContent(`#${id}`);

before(async () => {
  server = await preview({ root, preview: { port: 0 } });
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
      "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  page = await browser.newPage({ viewport: { width: 1200, height: 800 } });
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
  assert.equal((await distances()).length, 30);
  assert.match(await text("details"), /^Link \d+ of 30 is closest, [\d.]+ mm along the robot\.$/);
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
  const [mesh, line] = ["wall.stl", "shape.csv"].map((name) => join(root, "../examples/data", name));
  const expected = answer(line, mesh);
  assert.equal(expected.length, 30);
  await page.setInputFiles("#mesh-file", mesh);
  await page.setInputFiles("#line-file", line);
  const shown = (expected) => document.querySelector("#answer").dataset.distances === JSON.stringify(expected);
  await page.waitForFunction(shown, expected, { timeout: 10_000 }).catch(() => {});
  assert.deepEqual(await distances(), expected);
});

test("what is within the margin is named", async () => {
  await page.fill("#margin", "5");
  assert.match(await text("details"), /links? (is|are) within the margin/);
  await page.fill("#margin", "0");
});

const CUBE = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 60 60 0\nv 0 0 60\nv 60 0 60\nv 0 60 60\nv 60 60 60\n"
  + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

test("files of one's own, and what is wrong with them", async () => {
  const [mesh, line] = [file("cube.obj", CUBE), file("line.csv", "x,y,z,radius\n30,30,20,2\n30,30,30,1\n30,30,40\n")];
  await page.setInputFiles("#mesh-file", mesh);
  await page.setInputFiles("#line-file", line);
  await page.waitForFunction(() => document.querySelector("#answer").textContent === "20.000 mm");
  assert.deepEqual(await distances(), answer(line, mesh));
  await page.setInputFiles("#mesh-file", file("broken.stl", "no mesh"));
  await page.waitForFunction(() => /broken\.stl is not a valid STL file/.test(document.querySelector("#message").textContent));
  await page.setInputFiles("#line-file", file("bad.csv", "1,2,3\n1,two,3\n"));
  await page.waitForFunction(() => /line 2 is '1,two,3'/.test(document.querySelector("#message").textContent));
  assert.equal(await text("answer"), "20.000 mm");
});

test("a dropped file is read like a chosen one", async () => {
  const beside = "x,y,z,radius\n70,30,20,1\n70,30,40\n";
  await page.evaluate((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "beside.csv"));
    window.dispatchEvent(new DragEvent("drop", { dataTransfer: data }));
  }, beside);
  await page.waitForFunction(() => document.querySelector("#answer").textContent === "9.000 mm");
  assert.match(await text("details"), /base is outside the wall/);
});

test("a small window shows picture and answer", async () => {
  await page.click("#reset");
  await page.setViewportSize({ width: 360, height: 640 });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 360, `${wide}`);
  assert.ok(await page.isVisible("#answer") && await page.isVisible("#scene"));
  await page.setViewportSize({ width: 1200, height: 800 });
});

test("nothing went wrong on the way, and a picture is drawn", async () => {
  assert.deepEqual(complaints, []);
  const pictures = process.env.PICTURE;
  await page.reload();
  await page.waitForSelector("body[data-ready]", { timeout: 60_000 });
  const drawn = await page.screenshot(pictures ? { path: pictures } : {});
  assert.ok(drawn.length > 20_000);
});
