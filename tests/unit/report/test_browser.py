"""The report in a real browser: figures are drawn, nothing is fetched, nothing goes wrong."""

import os
import shutil

import pytest

WIDTHS = (1200, 420)


@pytest.fixture(scope="module")
def browser():
    """Headless Chromium; without it the test skips, but not in CI."""
    path = shutil.which("chromium")
    if path is None:
        message = "no chromium on this machine"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as running:
        opened = running.chromium.launch(
            executable_path=path, args=["--no-sandbox", "--disable-gpu"]
        )
        yield opened
        opened.close()


@pytest.mark.parametrize("width", WIDTHS)
def test_the_report_draws_all_figures_offline_and_without_an_error(browser, report, width):
    page = browser.new_page(viewport={"width": width, "height": 900})
    said, asked = [], []
    page.on("console", lambda message: said.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(report.as_uri())
    panels = page.locator(".panel")
    count = panels.count()
    assert count >= 15
    # the page's policy forbids strings as code, so it is asked again and again
    for _ in range(100):
        if page.locator(".panel .main-svg .plot").count() >= count:
            break
        page.wait_for_timeout(100)
    for k in range(count):
        panel = panels.nth(k)
        assert panel.locator(".point, .js-line, .js-fill").count() > 0, f"panel {k} is empty"
    assert said == []
    assert asked == [report.as_uri()]  # the page itself and nothing else
    assert page.title() == "Running safety study: small study"  # no text of a file was run
    assert page.evaluate("document.querySelectorAll('main img').length") == 0
    # nothing is wider than the window
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.close()


def test_pointing_at_a_run_shows_its_command_and_clicking_keeps_it(browser, report):
    page = browser.new_page(viewport={"width": 1200, "height": 900})
    page.goto(report.as_uri())
    point = page.locator("#figure-7-uplift .panel").first.locator(".point").first
    point.scroll_into_view_if_needed()
    box = point.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    label = page.locator("#figure-7-uplift .hoverlayer .hovertext").first
    label.wait_for()
    command = f"railquake rerun '{report.parent}'"
    assert command in label.text_content()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.locator("#command").wait_for()
    shown = page.locator("#command code").text_content()
    assert shown.startswith(command) and shown.endswith("--out result")
    page.close()


def test_the_legend_hides_a_model_in_all_panels(browser, report):
    page = browser.new_page(viewport={"width": 1200, "height": 900})
    page.goto(report.as_uri())
    figure = page.locator("#figures-8-9-decoupled")
    before = figure.locator(".point").count()
    figure.locator(".legend button").first.click()
    page.wait_for_timeout(500)
    assert 0 < figure.locator(".point").count() < before
    page.close()
