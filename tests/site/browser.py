# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Chromium without a window, spoken to through a pipe (the DevTools protocol)."""

import itertools
import json
import os
import queue
import subprocess
import tempfile
import threading

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-renderer-backgrounding", "--hide-scrollbars", "--remote-debugging-pipe"]


class Browser:
    """A browser with a profile of its own; `with` ends it."""

    def __enter__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        from_here, self.to_browser = os.pipe()
        self.from_browser, to_here = os.pipe()
        # The browser reads from 3 and writes to 4.
        self.process = subprocess.Popen(
            ["sh", "-c", f'exec "$@" 3<&{from_here} 4>&{to_here}', "sh", "chromium", *FLAGS, f"--user-data-dir={self.profile.name}"],
            pass_fds=(from_here, to_here), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(from_here)
        os.close(to_here)
        self.numbers, self.answers, self.tabs, self.lock = itertools.count(1), {}, {}, threading.Lock()
        threading.Thread(target=self.listen, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        os.close(self.to_browser)
        self.profile.cleanup()

    def listen(self):
        with os.fdopen(self.from_browser, "rb") as pipe:
            rest = b""
            while part := pipe.read1(1 << 20):
                *messages, rest = (rest + part).split(b"\0")
                for message in map(json.loads, messages):
                    if "id" in message:
                        self.answers.pop(message["id"]).put(message)
                    elif tab := self.tabs.get(message.get("sessionId")):
                        tab.events.put(message)
        for answer in list(self.answers.values()):
            answer.put({"error": {"message": "the browser has ended"}})

    def call(self, method, session=None, **parameters):
        """What the browser answers; a RuntimeError where it refuses or has not answered for a minute."""
        number, answer = next(self.numbers), queue.Queue()
        self.answers[number] = answer
        message = {"id": number, "method": method, "params": parameters} | ({"sessionId": session} if session else {})
        with self.lock:
            os.write(self.to_browser, json.dumps(message).encode() + b"\0")
        answered = answer.get(timeout=60)
        if "error" in answered:
            raise RuntimeError(f"{method}: {answered['error']['message']}")
        return answered["result"]


class Tab:
    """One page after another; what it says to its console is collected in `complaints`."""

    def __init__(self, browser):
        self.browser, self.events, self.complaints = browser, queue.Queue(), []
        target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        browser.tabs[self.session] = self
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def is_as_wide_as(self, width, height=900, is_dark=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}])

    def open(self, address):
        self.complaints.clear()
        self.call("Page.navigate", url=address)
        while (event := self.events.get(timeout=60))["method"] != "Page.loadEventFired":
            self.note(event)

    def note(self, event):
        said = event["params"]
        if event["method"] == "Runtime.exceptionThrown":
            self.complaints.append(said["exceptionDetails"].get("exception", {}).get("description", "an exception"))
        elif event["method"] == "Runtime.consoleAPICalled" and said["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(each.get("value", "")) for each in said["args"]))
        elif event["method"] == "Log.entryAdded" and said["entry"]["level"] in ("error", "warning"):
            self.complaints.append(said["entry"]["text"])
        elif event["method"] == "Network.requestWillBeSent" and not said["request"]["url"].startswith(("file:", "data:", "blob:")):
            self.complaints.append("asks the net for " + said["request"]["url"])

    def complained(self):
        """What its console was told since the page was opened."""
        while not self.events.empty():
            self.note(self.events.get())
        return list(self.complaints)

    def value_of(self, expression):
        """Of an expression of JavaScript, waited for where it is a promise."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["exception"].get("description", expression))
        return result["result"].get("value")

    def screenshot(self):
        """As PNG, in base 64."""
        self.call("Page.bringToFront")
        return self.call("Page.captureScreenshot", format="png")["data"]
