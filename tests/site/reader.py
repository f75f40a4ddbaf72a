# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""A tab with a reader before it: who looks, presses keys, drags, and swipes with a finger."""

import base64
import json
import time

from browser import Tab

KEYS = {"Tab": 9, "Enter": 13, "End": 35, "Home": 36, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}


class Reader(Tab):
    def wait_for(self, expression):
        """Until it is true, a minute at most."""
        until = time.monotonic() + 60
        while not self.value_of(expression):
            if time.monotonic() > until:
                raise RuntimeError(f"in a minute not true: {expression}")
            time.sleep(0.02)

    def wait_for_frames(self):
        """Until what was asked for in the last frame is drawn."""
        self.value_of("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))")

    def picture(self, path):
        """The whole page, as PNG."""
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True)["data"]
        path.write_bytes(base64.b64decode(data))

    def middle(self, selector):
        """Of an element, brought into view, in pixels of the window."""
        return self.value_of(f"""(element => {{
          element.scrollIntoView({{block: "center", behavior: "instant"}});
          const box = element.getBoundingClientRect();
          return [box.x + box.width / 2, box.y + box.height / 2];
        }})(document.querySelector({json.dumps(selector)}))""")

    def press(self, key):
        """A key, as ArrowRight, on what has the focus."""
        about = {"key": key, "code": key, "windowsVirtualKeyCode": KEYS[key]} | ({"text": "\r"} if key == "Enter" else {})
        self.call("Input.dispatchKeyEvent", type="keyDown", **about)
        self.call("Input.dispatchKeyEvent", type="keyUp", **about)

    def drag(self, start, end, steps=6):
        """From one place in the window to another, by the mouse."""
        def mouse(kind, place, buttons):
            self.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", buttons=buttons, clickCount=1)
        mouse("mousePressed", start, 1)
        for place in between(start, end, steps):
            mouse("mouseMoved", place, 1)
        mouse("mouseReleased", end, 0)

    def swipe(self, start, end, steps=6):
        """The same by a finger."""
        def touch(kind, *places):
            self.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y} for x, y in places])
        touch("touchStart", start)
        for place in between(start, end, steps):
            touch("touchMove", place)
        touch("touchEnd")


def between(start, end, steps):
    return [[a + (b - a) * i / steps for a, b in zip(start, end)] for i in range(1, steps + 1)]
