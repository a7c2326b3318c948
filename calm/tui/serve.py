"""The line builder in a browser of the same machine.

Each page that is opened is an application of its own. Only this machine is listened to, and of its
browsers only the page itself: what another site's page sends here is refused.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Awaitable, Callable, Sequence
from typing import Any

from aiohttp import web
from textual_serve.server import Server

from calm.errors import UsageError

HOST = "localhost"
_UNSAID = 80
"""The port that a browser leaves out of the address."""
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; "
    "font-src 'self' data:; img-src 'self' data:; connect-src 'self' ws:"
)

_ELSEWHERE = re.compile(r"<link[^>]*\shref=\"https?:[^>]*>")
"""What the page of textual-serve would have from other sites, a font: its policy refuses it."""

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Browser(Server):
    """A server for one person on one machine."""

    def __init__(self, words: Sequence[str], port: int, tell: Callable[[str], None]) -> None:
        # a shell is given the words: that of the system
        command = subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)
        address = HOST if port == _UNSAID else f"{HOST}:{port}"
        super().__init__(
            command, host=HOST, port=port, title="calm build", public_url=f"http://{address}"
        )
        self._tell = tell

    async def _make_app(self) -> web.Application:
        application = await super()._make_app()
        application.middlewares.append(self._only_own_page)
        application.router.add_get("/favicon.ico", _no_icon)
        return application

    async def on_startup(self, app: web.Application) -> None:
        """Say nothing: the port may be taken."""

    def serve(self, debug: bool = False) -> None:
        """Listen until it is interrupted, and say where as soon as it does."""
        self.debug = debug
        self.initialize_logging()
        told = f"calm build is at {self.public_url}; Ctrl+C ends it"
        web.run_app(
            self._make_app(), host=self.host, port=self.port, print=lambda *_: self._tell(told)
        )

    @web.middleware
    async def _only_own_page(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        names = (HOST, "127.0.0.1", "[::1]")
        own = {f"{name}:{self.port}" for name in names}
        own |= set(names) if self.port == _UNSAID else set()
        origin = request.headers.get("Origin")
        if request.host.lower() not in own or (
            origin is not None and origin.lower().removeprefix("http://") not in own
        ):
            raise web.HTTPForbidden(text="This page is for the machine that it runs on.")
        response = await handler(request)
        if isinstance(response, web.Response) and response.text:
            response.text = _ELSEWHERE.sub("", response.text)
        if not response.prepared:
            response.headers["Content-Security-Policy"] = _POLICY
        return response


async def _no_icon(_: web.Request) -> web.Response:
    """Browsers ask for it unasked."""
    return web.Response(status=204)


def serve(arguments: Sequence[str], port: int, tell: Callable[[str], None]) -> None:
    """Serve ``calm build`` with these arguments until it is interrupted.

    Raises
    ------
    UsageError
        The port cannot be listened to.
    """
    words = [sys.executable, "-m", "calm", "build", *arguments]
    try:
        Browser(words, port, tell).serve()
    except OSError as error:
        raise UsageError(f"port {port} cannot be used ({_reason(error)}); try --port") from None


def _reason(error: Any) -> str:
    return str(error.strerror or error)
