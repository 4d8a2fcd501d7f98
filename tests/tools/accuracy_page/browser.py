# SPDX-License-Identifier: Apache-2.0
"""A headless browser, driven by WebDriver [W3C 2018] through chromedriver, with the standard
library only. Used by report_page_test.py and scripts/dev/site.
"""
import base64
import json
import re
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--force-device-scale-factor=1",
]
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # How WebDriver marks an element in JSON.


def programs():
    """The browser and its driver, or nothing where one is missing."""
    found = shutil.which("chromium"), shutil.which("chromedriver")
    return found if all(found) else None


class Browser:
    """One page at a time. Sizes are in CSS pixels."""

    def __init__(self, flags=()):
        """`flags` are further options of the browser."""
        browser, driver = programs()
        self._folder = tempfile.TemporaryDirectory(prefix="relief-browser-")
        self._driver = subprocess.Popen([driver, "--port=0"], stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        self._base = f"http://127.0.0.1:{self._port()}"
        options = {"binary": browser, "args": FLAGS + list(flags) + [f"--user-data-dir={self._folder.name}"]}
        session = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
            "browserName": "chrome", "goog:chromeOptions": options,
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}}})
        self._base += f"/session/{session['sessionId']}"
        self._call("POST", "/timeouts", {"script": 600_000})  # Machines may be busy.

    def _port(self):
        for line in self._driver.stdout:
            started = re.search(r"started successfully on port (\d+)", line)
            if started:
                return int(started.group(1))
        raise RuntimeError("chromedriver did not start")

    def close(self):
        try:
            self._call("DELETE", "")
        finally:
            self._driver.terminate()
            self._driver.wait(10)
            self._driver.stdout.close()
            self._folder.cleanup()

    def _call(self, method, path, body=None):
        data = json.dumps(body or {}).encode() if method == "POST" else None
        request = urllib.request.Request(self._base + path, data, method=method,
                                         headers={"Content-Type": "application/json"})
        # No proxy: the driver is on this machine.
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=600) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def open(self, file):
        self.open_address(file.resolve().as_uri())

    def open_address(self, address):
        self._call("POST", "/url", {"url": address})

    def run(self, script, *arguments):
        """What a JavaScript function body returns; `arguments` are its own."""
        return self._call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait_for(self, script, seconds=30):
        """Until a JavaScript function body returns something true."""
        deadline = time.monotonic() + seconds
        while not self.run(script):
            if time.monotonic() > deadline:
                raise TimeoutError(script)
            time.sleep(0.02)

    def devtools(self, command, **parameters):
        return self._call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def resize(self, width, height, is_phone=False):
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height,
                      deviceScaleFactor=1, mobile=is_phone)

    def log(self, kind):
        """What was written since the last call: kind is "browser" (the console) or "performance"."""
        return self._call("POST", "/se/log", {"type": kind})

    def requests(self):
        """The addresses that were asked for since the last look at this log."""
        messages = [json.loads(entry["message"])["message"] for entry in self.log("performance")]
        return [message["params"]["request"]["url"] for message in messages
                if message["method"] == "Network.requestWillBeSent"]

    def screenshot(self, file):
        file.write_bytes(base64.b64decode(self._call("GET", "/screenshot")))
