#!/usr/bin/env python3
"""Opens a page in headless Chromium and looks at it: light, dark, and at the width of a phone.

Speaks the DevTools protocol over a pipe with the standard library alone. Checked for each look:
  - no request leaves the page: all that is asked for is the file itself and data: URLs, and a proxy
    that everything else would go through is never called;
  - nothing is reported to the console, every picture has been decoded;
  - the page does not scroll sideways;
  - text has a contrast of 4.5 against its ground (WCAG 2.1, 1.4.3), curves one of 3 (1.4.11);
  - the ground is light in light, dark in dark.
usage: browser.py PAGE FOLDER_FOR_SCREENSHOTS
"""
import base64
import json
import os
import pathlib
import select
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

LOOKS = [("light", "light", 1200), ("dark", "dark", 1200), ("phone", "light", 360), ("phone-dark", "dark", 360)]
# What Chromium asks for by itself, whatever it is told; what the page asks for is seen a second time as an event.
BROWSERS_OWN = ("update.googleapis.com", "clients2.google.com", "accounts.google.com", "android.clients.google.com",
                "content-autofill.googleapis.com", "optimizationguide-pa.googleapis.com", "redirector.gvt1.com",
                "www.google.com", "safebrowsing.googleapis.com", "edgedl.me.gvt1.com")

MEASURE = r"""
(() => {
  const number = text => text.match(/[\d.]+/g).map(Number);
  const light = rgb => {
    const [r, g, b] = rgb.map(v => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = element => {
    for (let e = element; e; e = e.parentElement) {
      const c = number(getComputedStyle(e).backgroundColor);
      if (c.length < 4 || c[3] > 0) return c.slice(0, 3);
    }
    return [255, 255, 255];
  };
  const contrast = (element, colour) => {
    const a = light(number(colour).slice(0, 3)), b = light(ground(element));
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  };
  const found = {texts: 0, curves: 0, pictures: document.images.length, low: [], undecoded: [], small: []};
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node; (node = walker.nextNode());) {
    const e = node.parentElement, style = getComputedStyle(e);
    if (!node.textContent.trim() || style.visibility === 'hidden' || !e.getClientRects().length) continue;
    const svg = e.closest('svg') !== null, ratio = contrast(e, svg ? style.fill : style.color);
    found.texts++;
    if (ratio < 4.5) found.low.push(`${ratio.toFixed(2)} ${node.textContent.trim().slice(0, 30)}`);
    const box = svg ? e.closest('svg') : null;
    const scale = box ? box.getBoundingClientRect().width / (box.viewBox.baseVal.width || 1) : 1;
    if (parseFloat(style.fontSize) * scale < 9.5)
      found.small.push(`${(parseFloat(style.fontSize) * scale).toFixed(1)} ${node.textContent.trim().slice(0, 30)}`);
  }
  for (const path of document.querySelectorAll('figure.chart path[class^=c]')) {
    const ratio = contrast(path.closest('figure'), getComputedStyle(path).stroke);
    found.curves++;
    if (ratio < 3) found.low.push(`${ratio.toFixed(2)} curve ${path.getAttribute('class')}`);
  }
  for (const image of document.images) if (!image.naturalWidth) found.undecoded.push(image.alt);
  found.scroll = document.documentElement.scrollWidth;
  found.width = document.documentElement.clientWidth;
  found.height = document.documentElement.scrollHeight;
  found.ground = light(number(getComputedStyle(document.body).backgroundColor));
  found.alts = [...document.images].every(i => i.alt) &&
    [...document.querySelectorAll('svg')].every(s => s.getAttribute('aria-label') || s.getAttribute('aria-hidden'));
  found.anchors = [...document.querySelectorAll('a[href^="#"]')].every(a => document.getElementById(a.getAttribute('href').slice(1)));
  return JSON.stringify(found);
})()
"""


class Browser:
    """Chromium behind two pipes: messages are JSON ended by a zero byte (--remote-debugging-pipe)."""

    def __init__(self, program, profile, proxy_port):
        to_read, self.to = os.pipe()
        self.back, back_write = os.pipe()

        def place_pipes():
            # both clear of 3 and 4 first, so that neither is closed by the other's move
            a, b = os.dup(to_read), os.dup(back_write)
            while a in (3, 4):
                a = os.dup(a)
            while b in (3, 4):
                b = os.dup(b)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
             f"--user-data-dir={profile}", f"--proxy-server=127.0.0.1:{proxy_port}", "--proxy-bypass-list=<-loopback>",
             "--no-first-run", "--disable-background-networking", "--disable-component-update",
             "--disable-default-apps", "--disable-sync", "--disable-extensions", "--no-default-browser-check",
             "--disable-domain-reliability", "--disable-client-side-phishing-detection", "--no-pings",
             "--disable-dev-shm-usage", "--metrics-recording-only", "--hide-scrollbars",
             "--disable-features=OptimizationHints,MediaRouter,Translate,AutofillServerCommunication,NetworkTimeServiceQuerying",
             "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            close_fds=False, preexec_fn=place_pipes)
        os.close(to_read)
        os.close(back_write)
        self.buffer, self.number, self.events, self.session = b"", 0, [], None

    def receive(self, deadline):
        while b"\0" not in self.buffer:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.back], [], [], left)[0]:
                raise SystemExit("the browser does not answer")
            got = os.read(self.back, 1 << 20)
            if not got:
                raise SystemExit(f"the browser has ended with code {self.process.wait()}")
            self.buffer += got
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.to, data):]
        deadline = time.monotonic() + 120
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise SystemExit(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, method):
        deadline = time.monotonic() + 120
        while not any(e.get("method") == method for e in self.events):
            self.events.append(self.receive(deadline))

    def attach(self):
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Log", "Runtime"):
            self.call(f"{domain}.enable")

    def end(self):
        self.session = None
        try:
            self.call("Browser.close")
        except SystemExit:
            pass
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def look(browser, url, scheme, width):
    """Loads the page anew in one look; returns what was measured, asked for and reported."""
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
    browser.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=width < 500)
    for address in ("about:blank", url):
        browser.events.clear()
        browser.call("Page.navigate", url=address)
        browser.wait_for("Page.loadEventFired")
    # folded parts are looked at, too
    browser.call("Runtime.evaluate", awaitPromise=True, expression="""
      document.querySelectorAll('details').forEach(d => d.open = true);
      Promise.all([...document.images].map(i => i.decode().catch(() => 0))).then(() => 1)""")
    measured = json.loads(browser.call("Runtime.evaluate", expression=MEASURE)["result"]["value"])
    asked = [e["params"]["request"]["url"] for e in browser.events if e.get("method") == "Network.requestWillBeSent"]
    reported = [e["params"] for e in browser.events
                if e.get("method") in ("Log.entryAdded", "Runtime.exceptionThrown", "Runtime.consoleAPICalled")]
    return measured, asked, reported


def screenshot(browser, path, width):
    browser.call("Runtime.evaluate", expression="document.querySelectorAll('details').forEach(d => d.open = false)")
    height = browser.call("Runtime.evaluate", expression="document.documentElement.scrollHeight")["result"]["value"]
    data = browser.call("Page.captureScreenshot", format="png", captureBeyondViewport=True,
                        clip={"x": 0, "y": 0, "width": width, "height": min(height, 12000), "scale": 1})["data"]
    path.write_bytes(base64.b64decode(data))


def judge(name, scheme, url, measured, asked, reported):
    wrong = []
    if not asked or asked[0] != url:
        wrong.append(f"the page itself was not seen to be asked for: {asked[:3]}")
    wrong += [f"asks for {u[:100]}" for u in asked[1:] if not u.startswith("data:")]
    wrong += [f"reports {str(r)[:200]}" for r in reported]
    if measured["scroll"] > measured["width"]:
        wrong.append(f"scrolls sideways: {measured['scroll']} px in {measured['width']} px")
    wrong += [f"low contrast: {t}" for t in measured["low"][:5]]
    wrong += [f"small text: {t}" for t in measured["small"][:5]]
    wrong += [f"not decoded: {t}" for t in measured["undecoded"]]
    if measured["texts"] < 50:
        wrong.append(f"only {measured['texts']} texts")
    if not measured["curves"]:
        wrong.append("there are no curves")
    if not measured["alts"]:
        wrong.append("a picture has no text in its place")
    if not measured["anchors"]:
        wrong.append("a link leads to no place of the page")
    if (measured["ground"] > 0.5) != (scheme == "light"):
        wrong.append(f"the ground has a luminance of {measured['ground']:.2f}")
    for w in wrong:
        print(f"{name}: {w}")
    return not wrong


class Proxy(threading.Thread):
    """Refuses all that it is asked for, and remembers it."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.called = []

    def run(self):
        while True:
            connection, _ = self.socket.accept()
            connection.settimeout(10)
            with connection:
                try:
                    self.called.append(connection.recv(400).decode("latin-1").split("\r\n")[0])
                    connection.sendall(b"HTTP/1.1 403 Forbidden\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
                except OSError:
                    pass


def main():
    page, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if program is None:
        print("chromium is not installed (Debian package chromium); skipped", file=sys.stderr)
        return 77
    folder.mkdir(parents=True, exist_ok=True)
    proxy = Proxy()
    proxy.start()
    profile = tempfile.mkdtemp(prefix="cdem-browser-")
    browser = Browser(program, profile, proxy.port)
    good = True
    try:
        browser.attach()
        for name, scheme, width in LOOKS:
            measured, asked, reported = look(browser, page.as_uri(), scheme, width)
            screenshot(browser, folder / f"{name}.png", width)
            good = judge(name, scheme, page.as_uri(), measured, asked, reported) and good
            print(f"{name}: {measured['width']} x {measured['height']} px, {measured['texts']} texts, "
                  f"{measured['curves']} curves, {measured['pictures']} pictures, {len(asked)} requests")
    finally:
        browser.end()
        shutil.rmtree(profile, ignore_errors=True)
    for call in proxy.called:
        own = any(host in call for host in BROWSERS_OWN)
        good = good and own
        if not own:
            print(f"the proxy was called: {call}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
