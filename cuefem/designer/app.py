"""The designer's page: knobs on one side, what they do on the other; one desk a browser tab.

NiceGUI, because a change is one message over a websocket and touches only what it changes (Streamlit runs the whole
script again, Dash and Panel send whole figures), its sliders have roles and keys, and all of it is served from here.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from nicegui import app, background_tasks, events, ui
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from cuefem.designer import numbers, pictures
from cuefem.designer.answers import Answers, Curve, Density, answers, coupled_points, density
from cuefem.designer.door import KINDS, LARGEST_FILE, REJECTED, Door, file_name
from cuefem.designer.model import Knobs, knobs_of, turned
from cuefem.designer.sliders import Choice, Slider, choices, sliders, without
from cuefem.designer.style import SCRIPT, STYLE
from cuefem.designer.words import ABOUT, Opened, head_markup
from cuefem.io.toml import toml_text
from cuefem.report.page import page as report_page
from cuefem.report.templates import page_style
from cuefem.report.unusual import unusual
from cuefem.scene import Scene

HOST = "127.0.0.1"
LONGEST_WORK = 60.0  # s that an answer may take: no cue that people play with needs a tenth of it
IDLE = 0.12  # s without a move before the slower results are computed
FAILURES = (ValueError, RuntimeError, ArithmeticError, MemoryError, OSError)

Read = Callable[[Path], tuple[Scene, list[str]]]


class Pinned(NamedTuple):
    """A design that others are compared with."""

    found: Answers
    coupled: Curve | None
    density: Density | None


def serve(first: Opened, read: Read, *, port: int, show: bool, announce: Callable[[str], None]) -> None:
    """Serve the page on this computer alone until it is stopped. show: open it in the browser."""

    @ui.page("/")
    def desk() -> None:
        Desk(first, read)

    app.add_middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"])
    app.add_middleware(Door, origins=(f"http://{HOST}:{port}", f"http://localhost:{port}"))
    app.on_startup(lambda: announce(f"http://{HOST}:{port}/"))
    ui.run(
        host=HOST,
        port=port,
        show=show,
        title="cuefem designer",
        favicon="data:,",
        dark=None,
        language="en-US",
        reload=False,
        tailwind=False,
        show_welcome_message=False,
    )


async def _computed(work: Callable[..., Any], *arguments: Any) -> Any:
    """Work done in a thread, with overflows as errors; RuntimeError if it takes too long."""

    def guarded() -> Any:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            return work(*arguments)

    try:
        return await asyncio.wait_for(asyncio.to_thread(guarded), LONGEST_WORK)
    except TimeoutError:
        raise RuntimeError(f"this takes more than {LONGEST_WORK:g} s: draw fewer segments, or check sizes") from None


class Desk:
    """What one browser tab works on. A move is answered at once; slower results follow while no knob is moved."""

    def __init__(self, first: Opened, read: Read) -> None:
        self.read, self.opened = read, first
        self.scene, self.knobs = first.scene, knobs_of(first.scene)
        self.found: Answers | None = None
        self.coupled: Curve | None = None
        self.density: Density | None = None
        self.pinned: Pinned | None = None
        self.moves = self.answered = 0
        self.busy = self.current = False
        self._build()
        ui.timer(0.05, self._moved, once=True)

    # --- what is there ---------------------------------------------------------------------------------------------

    def _build(self) -> None:
        ui.add_css(page_style() + STYLE)
        ui.add_body_html(SCRIPT)
        with ui.element("header"):
            self.head = ui.html(sanitize=False)
            with ui.element("div").classes("actions"):
                self._button("Open a file", lambda: self.upload.run_method("pickFiles"))
                self._button("Save as .toml", self._save)
                self.report = self._button("Write the report", self._report)
                self._button("Pin this design", self._pin)
                self.unpin = self._button("Take the pin off", self._unpin)
                self.unpin.set_visibility(False)
                self._button("Back to the file", lambda: self._open(self.opened))
            self.message = ui.html(sanitize=False).props('role="alert"').on("click", lambda: self._say(""))
        with ui.element("div").classes("unseen"):
            self.upload = ui.upload(
                auto_upload=True,
                max_file_size=LARGEST_FILE,
                on_rejected=lambda: self._say(f"not opened: {REJECTED}"),
            ).props(f'accept="{",".join(KINDS)}"')
            address = self.upload.props["url"]
            app.remove_route(address)  # NiceGUI's own takes no form without a file
            app.post(address, include_in_schema=False)(self._sent)
        with ui.element("div").classes("desk"):
            self.panel = ui.element("section").classes("knobs").props('aria-label="knobs"')
            self.side = ui.element("div").classes("answers")
            with self.side:
                self._build_answers()
        self._show_file()

    def _build_answers(self) -> None:
        with ui.element("section").classes("key-strip"):
            self.keys = ui.html(sanitize=False)
        with ui.element("div").classes("rest"):
            self.cue = self._section("The cue")
            self.charts = self._section("Squirt and pivot length against the offset")
            with ui.element("div").classes("grid2"):
                self.lives = self._section("Where end mass lives")
                with ui.element("section"):
                    ui.html("<h2>How it rings</h2>", sanitize=False)
                    self.shapes = ui.html(sanitize=False)
                    self.tones = ui.html(sanitize=False)
            self.table = self._section("All numbers")
            ui.html(ABOUT, sanitize=False)

    def _section(self, title: str) -> ui.html:
        with ui.element("section"):
            ui.html(f"<h2>{title}</h2>", sanitize=False)
            return ui.html(sanitize=False)

    def _button(self, words: str, action: Callable[..., Any]) -> ui.button:
        return ui.button(words, on_click=action, color=None).props("outline no-caps dense padding='0.25rem 0.8rem'")

    def _show_file(self) -> None:
        """The opened file's name and facts, and its knobs."""
        self.panel.clear()
        with self.panel:
            ui.html("<h2>Knobs</h2>", sanitize=False)
            for choice in choices(self.opened.scene):
                self._choice(choice)
            for slider in sliders(self.opened.scene):
                self._slider(slider)
            for words in without(self.opened.scene):
                ui.html(f'<p class="hint">{escape(words)}</p>', sanitize=False)

    def _choice(self, choice: Choice) -> None:
        def chosen(event: events.ValueChangeEventArguments[Any]) -> Any:
            changed: dict[str, Any] = {choice.knob: choice.materials[event.value]}
            return self._turn(replace(self.knobs, **changed))

        names = list(choice.materials)
        ui.select(names, value=choice.name(self.knobs), label=choice.label, on_change=chosen).props(
            f'outlined dense data-knob="{choice.knob}"'
        ).classes("choice")

    def _slider(self, slider: Slider) -> None:
        here = slider.shown(self.knobs)
        spoken = f"{slider.label}, {slider.unit}" if slider.unit else slider.label

        def moved(event: events.ValueChangeEventArguments[Any]) -> Any:
            number.set_value(event.value)
            return self._turn(slider.turned(self.knobs, float(event.value)))

        def within() -> bool:
            return number.value is not None and slider.low <= number.value <= slider.high

        def typed() -> None:
            if within():
                bar.set_value(number.value)

        def left() -> None:
            if not within():
                self._say(f"{slider.label} must be in [{slider.low:g}, {slider.high:g}] {slider.unit}".rstrip())
                number.set_value(bar.value)

        with ui.element("div").classes("knob"):
            with ui.element("div").classes("line"):
                ui.html(f"<span>{escape(slider.label)}</span>", sanitize=False)
                form = f"%.{slider.decimals}f"
                number = ui.number(value=here, step=slider.step, format=form, suffix=slider.unit, on_change=typed)
                number.props(f'dense borderless hide-bottom-space debounce=200 aria-label="{spoken}, as a number"')
                number.on("blur", left)
            bar = ui.slider(min=slider.low, max=slider.high, step=slider.step, value=here, on_change=moved)
            bar.props(f'role="none" aria-label="{spoken}" data-knob="{slider.knob}"')

    # --- what happens ----------------------------------------------------------------------------------------------

    def _say(self, words: str) -> None:
        """Say what went wrong, or clear the message."""
        self.message.set_content(f'<p class="said">{escape(words)}</p>' if words else "")

    async def _turn(self, knobs: Knobs) -> None:
        if knobs != self.knobs:
            self.knobs = knobs
            await self._moved()

    async def _moved(self) -> None:
        """Answer the newest move; one that came while the last was computed is answered after it."""
        self.moves += 1
        self.current = False
        self.side.props("aria-busy=true")
        if self.busy:
            return
        self.busy = True
        try:
            while self.answered < self.moves:
                self.answered = self.moves
                good = await self._answer()
        finally:
            self.busy = False
        move = self.moves
        if good:
            await self._refine(move)
        if move == self.moves:
            self.side.props("aria-busy=false")

    async def _answer(self) -> bool:
        try:
            scene = turned(self.opened.scene, self.knobs)
            self.found = await _computed(answers, scene)
        except FAILURES as error:
            self._say(f"{' '.join(str(error).split())}. The numbers are still those of the design before.")
            return False
        self.scene = scene
        self._say("")
        self._show_numbers()
        await asyncio.sleep(0)  # they are on their way while the pictures are drawn
        self._show_pictures()
        return True

    async def _refine(self, move: int) -> None:
        """Compute the coupled curve, then where end mass lives, unless a knob is moved meanwhile."""
        found, points = self.found, []
        assert found is not None
        await asyncio.sleep(IDLE)
        with suppress(*FAILURES):  # a strike at another offset may have no answer: then there is no curve
            work = coupled_points(found)
            while move == self.moves and (point := await _computed(next, work, None)):
                points.append(point)
            if move != self.moves:
                return
            self.coupled, self.current = pictures.curve_of(points), True
            self._show_charts()
            lives = await _computed(density, self.scene)
            if move == self.moves:
                self.density = lives
                self._show_density(current=True)

    def _show_numbers(self) -> None:
        found, pinned = self.found, self.pinned.found if self.pinned else None
        assert found is not None
        self.keys.set_content(numbers.key_markup(found, pinned))
        self.tones.set_content(numbers.tones_markup(found.frequencies.tolist()))
        self.table.set_content(numbers.table_markup(found, pinned))

    def _show_pictures(self) -> None:
        found = self.found
        assert found is not None
        self.cue.set_content(pictures.cue_pictures(found.scene))
        self.shapes.set_content(pictures.shapes_picture(found))
        self.head.set_content(head_markup(self.opened, found.scene))
        self._show_charts()
        self._show_density(current=self.current)

    def _show_charts(self) -> None:
        pinned = (self.pinned.found, self.pinned.coupled) if self.pinned else None
        if self.found is not None:
            self.charts.set_content(pictures.offset_charts(self.found, self.coupled, pinned, current=self.current))

    def _show_density(self, *, current: bool) -> None:
        if self.density is not None:
            pinned = self.pinned.density if self.pinned else None
            self.lives.set_content(pictures.density_chart(self.density, pinned))
        self.lives.classes(remove="stale") if current else self.lives.classes(add="stale")

    def _pin(self) -> None:
        if self.found is not None:
            self.pinned = Pinned(self.found, *((self.coupled, self.density) if self.current else (None, None)))
            self._show_pin()

    def _unpin(self) -> None:
        self.pinned = None
        self._show_pin()

    def _show_pin(self) -> None:
        self.unpin.set_visibility(self.pinned is not None)
        if self.found is not None:
            self._show_numbers()
            self._show_pictures()

    async def _open(self, opened: Opened) -> None:
        self.opened, self.knobs = opened, knobs_of(opened.scene)
        self._show_file()
        await self._moved()

    async def _sent(self, request: Request) -> Response:
        """Take a file from the browser at once, and read it after the request has been answered."""
        name, content, said = "", b"", "no file was sent"
        try:
            async with request.form(max_files=1, max_fields=10) as form:
                file = next((part for part in form.values() if isinstance(part, UploadFile)), None)
                if file is not None:
                    name, content, said = file_name(file.filename), await file.read(), ""
        except HTTPException:
            pass  # not a form
        except ValueError as error:
            said = str(error)
        except ClientDisconnect:
            return Response(status_code=400)
        if len(content) > LARGEST_FILE:
            said = REJECTED
        with self.upload:
            self.upload.reset()
            if said:
                self._say(f"not opened: {said}")
            else:
                background_tasks.create(self._uploaded(name, content), name="open a file")
        return Response(status_code=400 if said else 200)

    async def _uploaded(self, name: str, content: bytes) -> None:
        def read() -> tuple[Scene, list[str]]:
            with TemporaryDirectory() as folder:
                path = Path(folder) / name
                path.write_bytes(content)
                try:
                    scene, notes = self.read(path)
                    knobs_of(scene)
                except FAILURES as error:
                    raise ValueError(" ".join(str(error).split()).replace(f"{folder}/", "")) from None
            return scene, notes

        try:
            scene, notes = await _computed(read)
        except FAILURES as error:
            self._say(f"not opened: {error}")
        else:
            await self._open(Opened(name, scene, notes))

    def _save(self) -> None:
        """Save the design that the knobs say, even if its numbers are not there yet."""
        try:
            scene = turned(self.opened.scene, self.knobs)
        except FAILURES as error:
            self._say(f"not saved: {error}")
        else:
            ui.download.content(toml_text(scene), f"{Path(self.opened.name).stem}.toml")

    async def _report(self) -> None:
        scene, name = self.scene, self.opened.name
        self.report.disable()
        self._say("writing the report …")
        try:
            notes, remarks = self.opened.notes, unusual(scene)
            text = await _computed(lambda: report_page(name, scene, notes=notes, remarks=remarks))
        except FAILURES as error:
            self._say(" ".join(str(error).split()))
            return
        finally:
            self.report.enable()
        self._say("")
        ui.download.content(text, f"{Path(name).stem}.html")
