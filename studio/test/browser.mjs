// Serves a built page like an ordinary web server, and opens it in headless Chromium.

import { createServer } from "node:http";
import { existsSync } from "node:fs";
import { mkdir, readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { chromium } from "playwright-core";

const TYPES = {
  ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".json": "application/json", ".wasm": "application/wasm",
};

/** The path of the browser for the tests, or null. */
export function browserPath() {
  const known = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome", "/usr/bin/google-chrome-stable"];
  return process.env.DRIFTWORLD_BROWSER ?? known.find(existsSync) ?? null;
}

/** Serves a folder on loopback; `close` stops the server. */
export async function serve(folder) {
  const server = createServer(async (request, reply) => {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)).replace(/^\/+/, "") || "index.html";
    try {
      const bytes = await readFile(join(folder, name));
      reply.writeHead(200, { "content-type": TYPES[extname(name)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      reply.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

/** Window sizes and colour schemes of screenshots. */
export const SCREENS = {
  light: { width: 1280, height: 900, scheme: "light" },
  dark: { width: 1280, height: 900, scheme: "dark" },
  phone: { width: 390, height: 844, scheme: "light", isMobile: true, hasTouch: true },
};

/** A browser; `page(screen)` opens a new page that collects its errors in `page.faults`. */
export async function launch() {
  const browser = await chromium.launch({ executablePath: browserPath(), args: ["--no-sandbox", "--disable-gpu", "--force-color-profile=srgb"] });
  return {
    close: () => browser.close(),
    async page({ scheme, width, height, ...rest } = SCREENS.light) {
      const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, reducedMotion: "reduce", ...rest });
      const page = await context.newPage();
      page.faults = [];
      page.on("pageerror", (error) => page.faults.push(`error: ${error.message}`));
      page.on("console", (message) => message.type() === "error" && page.faults.push(`console: ${message.text()}`));
      page.on("requestfailed", (request) => page.faults.push(`request: ${request.url()}`));
      return page;
    },
  };
}

/** The elements that overflow the page horizontally, or whose text is cut off. */
export function overflow(page) {
  return page.evaluate(() => {
    const wide = document.documentElement.clientWidth;
    const name = (element) => `${element.tagName.toLowerCase()}.${element.className?.baseVal ?? element.className} "${element.textContent.slice(0, 30)}"`;
    const hides = (element) => element.closest(".hidden, .table, .bar nav, svg, .picks, option") !== null;
    return [...document.querySelectorAll("body *")].filter((element) => !hides(element)).flatMap((element) => {
      const box = element.getBoundingClientRect();
      if (box.width && (box.right > wide + 1 || box.left < -1)) return [`${name(element)} sticks out: ${Math.round(box.left)} to ${Math.round(box.right)}`];
      const style = getComputedStyle(element);
      const isClipped = style.overflowX === "hidden" && style.textOverflow !== "ellipsis" && element.scrollWidth > element.clientWidth + 1;
      return isClipped && element.childElementCount === 0 ? [`${name(element)} is cut off`] : [];
    });
  });
}

/** Saves a screenshot into the folder named by `DRIFTWORLD_SHOTS`, if it is set. */
export async function shot(page, name) {
  const folder = process.env.DRIFTWORLD_SHOTS;
  if (!folder) return;
  await mkdir(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
}
