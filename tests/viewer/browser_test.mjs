// The viewer as a user has it: the real service, and a real browser that looks at it.
// Reads the environment: AFTERGLOWD and PLAYWRIGHT, paths of the program and of the library's index.mjs; CHROMIUM, if it is not
// Debian's; SCREENSHOTS, a folder where pictures of the page are left.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, mkdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before } from "node:test";

const { chromium } = await import(process.env.PLAYWRIGHT);
const scene = new URL("../data/cornell-slide.glb", import.meta.url).pathname;
const screenshots = process.env.SCREENSHOTS;
const patience_ms = 90_000;

const data = mkdtempSync(join(tmpdir(), "afterglow-viewer-"));
let service;
let browser;
let page;
let address;

/** Starts the service on `port`, or any free one, and returns its address. */
async function serve(port = 0) {
  service = spawn(process.env.AFTERGLOWD, ["serve", "--listen", `127.0.0.1:${port}`, "--data", data], { stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  for (const stream of [service.stdout, service.stderr]) stream.on("data", (bytes) => (said += bytes));
  for (let k = 0; k < 400; ++k) {
    const found = said.match(/http:\/\/127\.0\.0\.1:\d+/);
    if (found) return found[0];
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`the service does not start: ${said}`);
}

function stop(signal = "SIGTERM") {
  return new Promise((resolve) => service.once("exit", resolve) && service.kill(signal));
}

const text = (selector) => page.locator(selector).textContent();
const shot = (name) => screenshots && page.screenshot({ path: join(screenshots, `${name}.png`) });

/** Waits until `condition(value)` holds in the page. (The library's own way needs eval, which the page's policy refuses.) */
async function until(condition, value) {
  for (const end = Date.now() + patience_ms; Date.now() < end; await page.waitForTimeout(50)) {
    if (await page.evaluate(condition, value)) return;
  }
  throw new Error(`never came true: ${condition} ${value ?? ""}`);
}

const until_connection_says = (words) => until((w) => document.querySelector("#connection").textContent.includes(w), words);

/** How many pixels of the picture are brighter than `least`, of 255, in some channel. */
const bright_pixels = (least) => page.evaluate((l) => {
  const canvas = document.querySelector("#picture");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) count += Math.max(data[i], data[i + 1], data[i + 2]) > l;
  return count;
}, least);

async function submit(frames, quality = "draft") {
  await page.setInputFiles("[name=scene]", scene);
  await page.fill("[name=frames]", frames);
  await page.selectOption("[name=quality]", quality);
  await page.selectOption("[name=size]", "320x180");
  await page.click("#submit button");
}

before(async () => {
  if (screenshots) mkdirSync(screenshots, { recursive: true });
  address = await serve();
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync"],
  });
  page = await browser.newPage({ viewport: { width: 1200, height: 1100 } });
});

after(async () => {
  await browser?.close();
  await stop();
  rmSync(data, { recursive: true });
});

test("a scene is uploaded, watched to its end, and looked through with the keyboard alone", async () => {
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  await page.goto(address);
  await submit("0-5");
  await until_connection_says("ended");
  await shot("ended");

  await page.focus("#strip");
  await page.keyboard.press("End");
  assert.match(await page.getAttribute("#strip", "aria-valuetext"), /^frame 5, converged, within [\d.]+ %$/);
  await page.keyboard.press("Home");
  assert.equal(await page.getAttribute("#strip", "aria-valuenow"), "0");
  await until(() => document.querySelector("#picture").getAttribute("aria-label").startsWith("frame 0, converged"));
  assert.ok((await bright_pixels(40)) > 1000, "the picture is not black");
  assert.equal(await text("#facts dd:first-of-type"), "succeeded");
  assert.deepEqual(problems, []);
});

test("two frames are compared: the difference is black for the same one and not for another", async () => {
  await page.selectOption("#compare", "difference");
  await until(() => document.querySelector("#picture").getAttribute("aria-label").includes("difference"));
  assert.equal(await bright_pixels(0), 0);
  await page.fill("#other-frame", "5");
  await page.keyboard.press("Tab");
  await until(() => document.querySelector("#picture").getAttribute("aria-label").includes("with frame 5"));
  assert.ok((await bright_pixels(0)) > 100);
  await shot("difference");

  await page.selectOption("#compare", "wipe");
  assert.ok(await page.isVisible("#wipe"));
  await shot("wipe");
  await page.selectOption("#compare", "none");
});

test("finished frames play", async () => {
  await page.click("#play");
  await until(() => Number(document.querySelector("#strip").getAttribute("aria-valuenow")) > 2);
  await page.click("#play");
  assert.equal(await page.getAttribute("#play", "aria-pressed"), "false");
});

test("a click on the error's curve goes to the frame of the nearest point, also where nobody watched", async () => {
  await page.reload();
  await until_connection_says("ended");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuemax") === "5");
  await page.waitForTimeout(500);
  await page.focus("#strip");
  await page.keyboard.press("Home");
  const plot = await page.locator("#chart .u-over").boundingBox();
  await page.mouse.click(plot.x + plot.width - 2, plot.y + plot.height / 2);
  await until(() => document.querySelector("#strip").getAttribute("aria-valuenow") === "5");
});

test("a page finds its way back when the service has crashed and started again", async () => {
  await submit("0-48", "preview");
  await until(() => [...document.querySelectorAll("#jobs button")].some((b) => b.textContent.includes("of 49 frames")));
  await until(() => document.querySelector("#strip").getAttribute("aria-valuemax") === "48");
  await page.focus("#strip");
  await page.keyboard.press("Home");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuetext").includes("converged"));
  await stop("SIGKILL");
  await until_connection_says("trying again");
  await shot("lost");
  await serve(Number(new URL(address).port));
  await until_connection_says("ended");
  assert.equal(await text("#facts dd:first-of-type"), "succeeded");
  await page.focus("#strip");
  await page.keyboard.press("End");
  assert.match(await page.getAttribute("#strip", "aria-valuetext"), /^frame 48, converged/);
});

test("a lamp is dimmed and an object moved with the keyboard, and the pictures follow", async () => {
  await page.goto(address);
  await submit("0-3");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuemax") === "3");
  await until_connection_says("ended");
  await page.focus("#strip");
  await page.keyboard.press("Home");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuetext").startsWith("frame 0, converged"));
  const bright = await bright_pixels(120);
  assert.ok(bright > 300);

  await until(() => document.querySelector("#edit [name=lamp]").value === "lamp");
  await page.focus("#edit [name=dim]");
  await page.keyboard.press("Home");
  for (let k = 0; k < 4; ++k) await page.keyboard.press("ArrowRight");
  await until(() => document.querySelector("#dimmed").value.startsWith("20 %"));
  await until(() => /[1-9] edits?; the newest kept/.test(document.querySelector("#edit [name=said]").value));
  await until_connection_says("ended");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuetext").startsWith("frame 0, converged"));
  await page.waitForTimeout(500);
  assert.ok((await bright_pixels(120)) < bright / 2, "it is darker");
  await shot("dimmed");

  // A longer job is edited while it runs, so that stale frames can be seen.
  await submit("0-48", "preview");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuemax") === "48");
  await until(() => document.querySelector("#edit [name=object]").value === "floor");
  await page.focus("#strip");
  await page.keyboard.press("Home");
  for (let k = 0; k < 3; ++k) await page.keyboard.press("ArrowRight");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuetext").startsWith("frame 3, converged"));
  await page.selectOption("#edit [name=object]", "tall_block");
  await page.fill("#edit [name=x]", "-0.1");
  await page.keyboard.press("Enter");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuetext") === "frame 3, stale");
  await shot("edit");
  await until(() => /1 edit; the newest kept \d+ %/.test(document.querySelector("#edit [name=said]").value));
  await shot("edited");
  await until(() => document.querySelector("#strip").getAttribute("aria-valuetext").startsWith("frame 3, converged"));
  await page.click("#controls button:last-child");
  await until(() => document.querySelector("#edit [name=edits]").disabled);
});

test("what the service refuses is said in words, in sight", async () => {
  await submit("7-3");
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await text("#message"), /frames/);
  const { y, height } = await page.locator("#message").boundingBox();
  assert.ok(y >= 0 && y + height <= 1100);
  await shot("refused");
});

test("nothing is cut off on a narrow screen", async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.reload();
  await until(() => document.querySelector("#strip").getAttribute("aria-valuemax") === "48");
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390);
  await page.waitForTimeout(500);
  if (screenshots) await page.screenshot({ path: join(screenshots, "narrow.png"), fullPage: true });
});
