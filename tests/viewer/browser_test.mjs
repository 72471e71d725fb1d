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

test("a click on the error's curve goes to the frame of the nearest point", async () => {
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

test("what the service refuses is said in words", async () => {
  await submit("7-3");
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await text("#message"), /frames/);
  await shot("refused");
});
