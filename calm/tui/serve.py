"""The line builder in a browser.

Each page that is opened is an application of its own. Only this machine is listened to; the page
needs the token of its address, and what another site's page sends here is refused.
"""

import os
import secrets
import shlex
import subprocess
import sys
from collections.abc import Awaitable, Callable, Sequence
from html import escape
from importlib.resources import files
from ipaddress import ip_address
from string import Template
from urllib.parse import urlsplit

from aiohttp import web
from textual_serve.server import Server

from calm.errors import UsageError

HOST = "localhost"
_UNSAID = 80
"""The port that a browser leaves out of the address."""
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; "
    "font-src 'self' data:; img-src 'self' data:; connect-src 'self' ws: wss:; "
    "frame-ancestors 'none'"
)
_TITLE = "calm build"

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Browser(Server):
    """A server for one person.

    Parameters
    ----------
    words : the command that each page runs
    tell : says where the page is
    token : that the address of the page has; a random one as a rule
    """

    def __init__(
        self,
        words: Sequence[str],
        port: int,
        tell: Callable[[str], None],
        *,
        token: str = "",
    ) -> None:
        # a shell is given the words: that of the system
        command = subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)
        super().__init__(command, host=HOST, port=port, title=_TITLE)
        self.token = token or secrets.token_urlsafe(24)
        self._tell = tell

    @property
    def address(self) -> str:
        """Return where the page is."""
        where = HOST if self.port == _UNSAID else f"{HOST}:{self.port}"
        return f"http://{where}/?token={self.token}"

    async def _make_app(self) -> web.Application:
        application = web.Application(middlewares=[self._only_own_page])
        application.router.add_get("/", self.handle_index)
        application.router.add_get("/ws/{token}", self.handle_websocket)
        application.router.add_get("/favicon.ico", _no_icon)
        application.router.add_static("/static", self.statics_path)
        return application

    def serve(self, debug: bool = False) -> None:
        """Listen until it is interrupted, and say where as soon as it does."""
        greeting = f"calm build is at {self.address}\nCtrl+C ends it"
        web.run_app(
            self._make_app(), host=self.host, port=self.port, print=lambda *_: self._tell(greeting)
        )

    async def handle_index(self, request: web.Request) -> web.Response:
        """The page; all that it names is beside it, whatever address it was asked for under."""
        self._check_token(request.query.get("token", ""))
        page = Template((files("calm.tui") / "page.html").read_text(encoding="utf-8"))
        text = page.substitute(title=escape(self.title))
        return web.Response(text=text, content_type="text/html")

    async def handle_websocket(self, request: web.Request) -> web.WebSocketResponse:
        """The keys and the screen of a page."""
        self._check_token(request.match_info["token"])
        return await super().handle_websocket(request)

    def _check_token(self, token: str) -> None:
        if not secrets.compare_digest(token.encode(), self.token.encode()):
            raise web.HTTPForbidden(
                text="The address lacks its token: open the one that `calm build --serve` printed."
            )

    @web.middleware
    async def _only_own_page(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        asked_of = _name(f"//{request.host}")
        if not self._is_own(asked_of) or (origin is not None and not self._is_own(_name(origin))):
            raise web.HTTPForbidden(text=f"{asked_of} is not this machine: use a tunnel")
        response = await handler(request)
        if not response.prepared:
            response.headers["Content-Security-Policy"] = _POLICY
            response.headers["Referrer-Policy"] = "no-referrer"
        return response

    def _is_own(self, name: str) -> bool:
        """Return whether a name is that of this machine."""
        if name == HOST:
            return True
        try:
            return ip_address(name).is_loopback
        except ValueError:
            return False


def _name(address: str) -> str:
    """The host of an address, without its port; empty where it has none."""
    try:
        return (urlsplit(address).hostname or "").lower()
    except ValueError:
        return ""


async def _no_icon(_: web.Request) -> web.Response:
    """Browsers ask for it unasked."""
    return web.Response(status=204)


def serve(arguments: Sequence[str], port: int, tell: Callable[[str], None]) -> None:
    """Serve ``calm build`` with these arguments until it is interrupted; see `Browser`.

    Raises
    ------
    UsageError
        The port cannot be listened to.
    """
    words = [sys.executable, "-m", "calm", "build", *arguments]
    try:
        Browser(words, port, tell).serve()
    except OSError as error:
        raise UsageError(
            f"port {port} cannot be used ({error.strerror or error}); try --port"
        ) from None
