"""A page in a real browser, which is started once and opens a tab for each page."""

import atexit
import base64
import itertools
import json
import shutil
import subprocess
import tempfile
import threading
from contextlib import contextmanager
from functools import cache

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
RAN = "window.ran = 1"
HOSTILE = [
    f"<script>{RAN};alert(1)</script>", f'"><img src=x onerror="{RAN}">', f"</title><script>{RAN}</script>",
    f"<svg/onload='{RAN}'>",
    f"</style><style>body {{ display: none }}</style>--><script>{RAN}</script>", f"' onmouseover='{RAN}' x='", "]]>${1}{{7*7}}",
    f'<iframe src="javascript:parent.{RAN}"></iframe>', "<base href=https://x.invalid/>", f"javascript:{RAN}", "__proto__",
    "<meta http-equiv=refresh content='0;url=https://x.invalid/'>", "<link rel=stylesheet href=https://x.invalid/a.css>",
    f"&lt;script&gt;{RAN}", f"\\u003cscript>{RAN}</script>", "\u202eKCAB\u2066a\u200b\u061c", "A" * 3000,
    "/".join(60 * ["x" * 30]),
    "<form action=https://x.invalid/><button>", "<!--", "</script></body></html>", "url(https://x.invalid/x.png)",
]  # fmt: skip
"""Names, some of which would run a script or fetch a file if they were no words."""
# Runs before the page: records errors
WATCH = """
const wrong = [];
addEventListener("error", (event) => wrong.push(event.message), true);
addEventListener("securitypolicyviolation", (event) => wrong.push(event.violatedDirective));
"""
LOADED = "new Promise((done) => document.readyState === 'complete' ? done() : addEventListener('load', done))"
# Runs after it, with `found` to be filled
ACT = """(async () => {
const found = {};
const at = (node, fx, fy, kind = "pointermove", pointerType = "mouse") => {
  const box = node.getBoundingClientRect();
  const where = { clientX: box.left + fx * box.width, clientY: box.top + fy * box.height };
  node.dispatchEvent(new PointerEvent(kind, { ...where, pointerType, bubbles: true }));
};
const press = (node, key) => node.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const tip = () => document.querySelector("#tip").hidden ? null : document.querySelector("#tip").textContent;
const later = () => new Promise((resolve) => setTimeout(resolve, 100));
%s
await later(); // a request that is stopped is reported late
found.wrong = wrong;
found.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
found.wide = document.documentElement.scrollWidth <= innerWidth;
return found;
})()"""


def browse(page, act="", *, size=(1200, 900)):
    """Return what ``act``, run after the page's own script, fills into ``found``."""
    with tab(page, size) as ask:
        done = ask("Runtime.evaluate", expression=ACT % act, awaitPromise=True, returnByValue=True)
    assert "exceptionDetails" not in done, done
    return done["result"]["value"]


def printed(page):
    """Return the page as a PDF."""
    with tab(page, (1200, 900)) as ask:
        return base64.b64decode(ask("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"])


@contextmanager
def tab(page, size):
    """Open a page and give the function that sends commands to it."""
    browser = chromium()
    target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
    session = browser.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def ask(method, **params):
        return browser.ask(method, session, **params)

    watch = threading.Timer(120.0, browser.process.kill)
    watch.start()
    ask("Page.enable")  # without which no script runs before the page
    ask("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False)
    ask("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
    ask("Page.navigate", url=page.as_uri())
    ask("Runtime.evaluate", expression=LOADED, awaitPromise=True)
    try:
        yield ask
    finally:
        watch.cancel()
        browser.ask("Target.closeTarget", targetId=target)


@cache
def chromium():
    """Start Chromium, which is closed at the end."""
    return Browser()


class Browser:
    """Chromium, driven by the DevTools protocol: JSON between zero bytes, through the file descriptors 3 and 4."""

    def __init__(self):
        profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        options = "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile.name}"
        piped = 'exec "$0" "$@" 3<&0 4>&1 </dev/null >/dev/null 2>&1'
        command = ["sh", "-c", piped, CHROMIUM, *options, "--remote-debugging-pipe"]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.numbers = itertools.count()
        self.unread = b""
        atexit.register(self.end, profile)

    def end(self, profile):
        with self.process:
            self.process.kill()
        profile.cleanup()

    def ask(self, method, session=None, **params):
        """Send a command and return its result."""
        number = next(self.numbers)
        command = {"id": number, "method": method, "params": params} | ({"sessionId": session} if session else {})
        self.process.stdin.write(json.dumps(command).encode() + b"\0")
        self.process.stdin.flush()
        while (message := self.message()).get("id") != number:
            pass
        assert "error" not in message, message
        return message["result"]

    def message(self):
        while b"\0" not in self.unread:
            received = self.process.stdout.read1(1 << 20)
            assert received, "Chromium has ended"
            self.unread += received
        first, _, self.unread = self.unread.partition(b"\0")
        return json.loads(first)
