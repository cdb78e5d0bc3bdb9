"""Opens a page of `whipple report` in a headless Chromium and uses its viewer. Arguments: page, folder for
screenshots, further pages that are opened alone."""

import base64
import json
import pathlib
import sys

from browser import Browser, program

SEEN = """(() => {
  const canvas = document.getElementById("canvas"), copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const plain = copy.getContext("2d");
  plain.drawImage(canvas, 0, 0);
  const pixels = plain.getImageData(0, 0, copy.width, copy.height).data;
  let [count, sum] = [0, 0];
  for (let k = 0; k < pixels.length; k += 4) {
    count += pixels[k + 3] > 0;
    sum = (31 * sum + pixels[k] + 7 * pixels[k + 1] + 17 * pixels[k + 2] + pixels[k + 3]) % 4294967296;
  }
  return [count / (copy.width * copy.height), sum];
})()"""
FRAME = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"


def seen(browser):
    """The share of the canvas that is painted, and a number that stands for the picture."""
    browser.run(FRAME)
    return browser.run(SEEN)


def put(browser, name, value):
    """Sets a control as a hand would."""
    browser.run(f"""(() => {{ const at = document.querySelector({json.dumps(name)});
        if (at.type === "checkbox") at.checked = {str(bool(value)).lower()}; else at.value = "{value}";
        at.dispatchEvent(new Event("input", {{ bubbles: true }})); }})()""")


def changes(browser, what, do):
    """Fails unless the picture changes; gives the painted share."""
    before = seen(browser)
    do()
    after = seen(browser)
    assert before[1] != after[1], f"{what} does not change the picture"
    return after[0]


def viewer(browser):
    """Uses all controls of the viewer."""
    browser.until("document.getElementById('clock')?.textContent", "no frame is shown")
    share = seen(browser)[0]
    assert share > 0.02, f"{share} of the canvas is painted"
    last = browser.run("document.getElementById('clock').textContent")

    def first():
        put(browser, "#time", 0)
        browser.until(f"document.getElementById('clock').textContent !== '{last}'", "the slider does nothing")
    changes(browser, "the slider", first)
    put(browser, "#time", 999)
    browser.until(f"document.getElementById('clock').textContent === '{last}'", "the slider does not come back")

    fewer = changes(browser, "a body", lambda: put(browser, "[data-body='0']", 0))
    assert fewer < share, "less is painted without a body"
    bodies = browser.run("document.querySelectorAll('[data-body]').length")
    for k in range(bodies):
        put(browser, f"[data-body='{k}']", 0)
    assert seen(browser)[0] == 0, "without bodies nothing is painted"
    for k in range(bodies):
        put(browser, f"[data-body='{k}']", 1)

    changes(browser, "a field", lambda: put(browser, "#colour", 1))
    legend = browser.run("[...document.querySelectorAll('#ticks span')].map((tick) => tick.textContent)")
    assert len(legend) == 5 and all(any(c.isdigit() for c in tick) for tick in legend), legend
    changes(browser, "a cut", lambda: put(browser, "#cut", 2))
    changes(browser, "the place of the cut", lambda: put(browser, "#cut-at", 900))
    changes(browser, "the other side", lambda: put(browser, "#other-side", 1))
    put(browser, "#cut", -1)
    if browser.run("document.querySelectorAll('[data-mirror]').length"):
        changes(browser, "a mirror", lambda: put(browser, "[data-mirror='0']", 0))
        put(browser, "[data-mirror='0']", 1)

    browser.run("document.getElementById('canvas').focus()")
    for key, text in [("ArrowLeft", ""), ("ArrowUp", ""), ("+", "+"), ("-", "-")]:
        changes(browser, key, lambda key=key, text=text: browser.key(key, text))
    browser.key(" ", " ")
    browser.until(f"document.getElementById('clock').textContent !== '{last}'", "space does not play")
    browser.key(" ", " ")
    put(browser, "#time", 999)
    browser.until(f"document.getElementById('clock').textContent === '{last}'", "the slider does not come back")
    browser.key("Home")


def touch(browser):
    """One finger turns, two zoom."""
    box = browser.run("""(() => { const canvas = document.getElementById("canvas"); canvas.scrollIntoView({ block: "center" });
        const box = canvas.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()""")

    def move(*fingers):
        for kind, way in [("touchStart", 0), ("touchMove", 1), ("touchEnd", None)]:
            points = [] if way is None else [
                {"x": box[0] + x + way * dx, "y": box[1] + way * dy, "id": k} for k, (x, dx, dy) in enumerate(fingers)]
            browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    changes(browser, "a finger", lambda: move((0, 60, 20)))
    changes(browser, "two fingers", lambda: move((-30, -40, 0), (30, 40, 0)))


def main(page, folder, *others):
    browser = Browser()
    try:
        browser.size(1280, 900)
        browser.open(page)
        viewer(browser)
        put(browser, "#colour", 0)
        save(browser, folder / "1280.png")
        browser.size(390, 844, touch=True)
        browser.open(page)
        browser.until("document.getElementById('clock')?.textContent", "no frame is shown")
        touch(browser)
        put(browser, "#colour", 1)
        browser.run("scrollTo(0, 0)")
        seen(browser)
        width = browser.run("document.documentElement.scrollWidth")
        assert width <= 390, f"the page is {width} pixels wide on a screen of 390"
        save(browser, folder / "390.png")
        browser.call("Page.addScriptToEvaluateOnNewDocument", source="HTMLCanvasElement.prototype.getContext = () => null")
        browser.open(page)
        assert browser.run("getComputedStyle(document.getElementById('no-viewer')).display") == "block", "no message"
        assert browser.run("document.getElementById('live').hidden"), "a viewer without WebGL"
        for other in others:
            browser.open(other)
        away = [url for url in browser.requests if not url.startswith(("file:", "data:", "about:"))]
        assert not away, f"asks the network: {away}"
        assert not browser.errors, f"the console says {browser.errors}"
        assert browser.run("window.hostile === undefined"), "a text of the run has run"
        print(f"no errors, {len(browser.requests)} requests, all on disk; screenshots in {folder}")
    finally:
        browser.close()


def save(browser, path):
    seen(browser)
    path.write_bytes(base64.b64decode(browser.picture()))


if __name__ == "__main__":
    if not program():
        sys.exit("no Chromium: jobs/install-deps.sh --tests installs it")
    main(*map(pathlib.Path, sys.argv[1:]))
