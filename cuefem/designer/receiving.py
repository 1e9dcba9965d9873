"""Files that the browser sends: taken at once, and read after the request has been answered."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable

from nicegui import app, background_tasks, ui
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from cuefem.designer.door import LARGEST_FILE, REJECTED, file_name


class Receiver:
    """An upload without a face. taken: gets a file's name and content; say: gets what is wrong."""

    def __init__(
        self, kinds: tuple[str, ...], taken: Callable[[str, bytes], Awaitable[None]], say: Callable[[str], None]
    ) -> None:
        self.taken, self.say = taken, say
        self.upload = ui.upload(
            auto_upload=True,
            max_file_size=LARGEST_FILE,
            on_rejected=lambda: say(f"not opened: {REJECTED}"),
        ).props(f'accept="{",".join(kinds)}"')
        self.address = str(self.upload.props["url"])
        client = ui.context.client
        client.on_connect(lambda: client.run_javascript(f"cuefem.sends({json.dumps(self.address)})"))
        app.remove_route(self.address)  # NiceGUI's own takes no form without a file
        app.post(self.address, include_in_schema=False)(self._sent)

    def pick(self) -> None:
        """Let the person choose a file."""
        self.upload.run_method("pickFiles")

    async def _sent(self, request: Request) -> Response:
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
                self.say(f"not opened: {said}")
            else:
                background_tasks.create(self.taken(name, content), name="open a file")
        return Response(status_code=400 if said else 200)
