"""A page in a real browser."""

import base64
import hashlib
import json
import re
import shutil
import subprocess

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
# Runs before the page: records errors
WATCH = """
const wrong = [];
addEventListener("error", (event) => wrong.push(event.message), true);
addEventListener("securitypolicyviolation", (event) => wrong.push(event.violatedDirective));
"""
# Runs after it, in a block of its own, with `found` to be filled
ACT = """{
const found = {};
const at = (node, fx, fy, kind = "pointermove", pointerType = "mouse") => {
  const box = node.getBoundingClientRect();
  const where = { clientX: box.left + fx * box.width, clientY: box.top + fy * box.height };
  node.dispatchEvent(new PointerEvent(kind, { ...where, pointerType, bubbles: true }));
};
const press = (node, key) => node.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const tip = () => document.querySelector("#tip").hidden ? null : document.querySelector("#tip").textContent;
%s
setTimeout(() => { // a request that is stopped is told later
found.wrong = wrong;
found.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
found.wide = document.documentElement.scrollWidth <= innerWidth;
const result = document.createElement("script");
result.type = "application/json";
result.id = "found";
result.textContent = JSON.stringify(found);
document.body.append(result);
}, 500);
}"""


def browse(tmp_path, page, act="", *, size=(1200, 900)):
    """Return what ``act``, run after the page's own script, fills into ``found``."""
    text = page.read_text(encoding="utf-8")
    scripts = WATCH, ACT % act
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    text = text.replace("script-src ", "script-src " + " ".join(f"'sha256-{digest}'" for digest in hashes) + " ", 1)
    text = text.replace("<title>", f"<script>{scripts[0]}</script><title>", 1)
    text = text.replace("</body>", f"<script>{scripts[1]}</script></body>")
    driven = tmp_path / "driven.html"
    driven.write_text(text, encoding="utf-8")
    done = chromium(tmp_path, "--dump-dom", f"--window-size={size[0]},{size[1]}", driven.as_uri())
    return json.loads(re.search(r'id="found">(.*?)</script>', done, re.DOTALL)[1])


def chromium(tmp_path, *arguments):
    options = "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"
    command = [CHROMIUM, *options, "--virtual-time-budget=3000", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout
