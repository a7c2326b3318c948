"""The line builder in a browser of the same machine.

Each page that is opened is an application of its own. Only this machine is listened to, and of its
browsers only the page itself: what another site's page sends here is refused.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Awaitable, Callable, Sequence
from typing import Any

from aiohttp import web
from textual_serve.server import Server

from calm.errors import UsageError

HOST = "localhost"
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; "
    "font-src 'self' data:; img-src 'self' data:; connect-src 'self' ws:"
)

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Browser(Server):
    """A server for one person on one machine."""

    def __init__(self, words: Sequence[str], port: int, tell: Callable[[str], None]) -> None:
        super().__init__(shlex.join(words), host=HOST, port=port, title="calm build")
        self._tell = tell

    async def _make_app(self) -> web.Application:
        application = await super()._make_app()
        application.middlewares.append(self._only_own_page)
        return application

    async def on_startup(self, app: web.Application) -> None:
        """Say where it is."""
        self._tell(f"calm build is at {self.public_url}; Ctrl+C ends it")

    @web.middleware
    async def _only_own_page(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        own = {f"{name}:{self.port}" for name in (HOST, "127.0.0.1", "[::1]")}
        origin = request.headers.get("Origin")
        if request.host not in own or (
            origin is not None and origin.removeprefix("http://") not in own
        ):
            raise web.HTTPForbidden(text="This page is for the machine that it runs on.")
        response = await handler(request)
        if not response.prepared:
            response.headers["Content-Security-Policy"] = _POLICY
        return response


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
