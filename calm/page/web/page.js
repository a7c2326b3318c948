// The page itself: terminal, buttons, files. Python runs in worker.js, so that none of this waits for it.
const $ = (id) => document.getElementById(id);
const settings = await (await fetch("page.json")).json();
const versioned = (name) => (/^(https?:|runtime\/)/.test(name) ? name : `${name}?v=${settings.built}`);

// offline: from the first visit on, everything that was loaded is kept
if ("serviceWorker" in navigator) {
  try {
    await navigator.serviceWorker.register(`offline.js?v=${settings.built}`);
    if (!navigator.serviceWorker.controller) {
      await new Promise((done) => {
        navigator.serviceWorker.addEventListener("controllerchange", done, { once: true });
        setTimeout(done, 3000);
      });
    }
  } catch (error) {
    console.info(`not kept for use without a network: ${error.message}`);
  }
}

const loaded = (element) => new Promise((done, failed) => {
  element.onload = done;
  element.onerror = () => failed(new Error(`${element.src || element.href} cannot be loaded`));
  document.head.append(element);
});

function tell(text, failed = false) {
  $("told").textContent = text;
  $("told").classList.toggle("failed", failed);
}

function stop(reason) {
  $("stage").textContent = `The page cannot start: ${reason}`;
  $("progress").hidden = true;
}

// files: the handle of a file lets Save write it where it was opened
const handles = new Map();

async function put(name, content, kind) {
  const handle = handles.get(name);
  if (kind === "saved" && handle) {
    try {
      if ((await handle.requestPermission({ mode: "readwrite" })) === "granted") {
        const stream = await handle.createWritable();
        await stream.write(content);
        await stream.close();
        tell(`${name} saved on this computer`);
        return;
      }
    } catch (error) {
      console.info(`not written in place: ${error.message}`);
    }
  }
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type: "application/octet-stream" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  tell(`${name} is in the downloads of this browser`);
}

const contents = (files) => Promise.all(files.map(async (file) => [file.name, new Uint8Array(await file.arrayBuffer())]));

// Keys without text, in Textual's notation. Characters, also those of AltGr and dead keys, come as text.
const KEYS = { ArrowUp: "up", ArrowDown: "down", ArrowLeft: "left", ArrowRight: "right", PageUp: "pageup", PageDown: "pagedown",
  Home: "home", End: "end", Insert: "insert", Delete: "delete", Backspace: "backspace", Enter: "enter", Tab: "tab", Escape: "escape" };
const OF_BROWSER = ["ctrl+v", "shift+insert", "f11", "f12"]; // pastes arrive by their own event

function keyName(event) {
  const { key, shiftKey: shift, metaKey: meta } = event;
  const third = event.getModifierState("AltGraph");
  const [alt, ctrl] = [event.altKey && !third, event.ctrlKey && !third];
  const named = KEYS[key] || (/^F\d+$/.test(key) && key.toLowerCase());
  const lettered = (ctrl || alt) && /^[\x21-\x7e]$/.test(key) && key.toLowerCase();
  if (meta || event.isComposing || !(named || lettered) || (lettered && shift)) return null;
  const name = [alt && "alt", ctrl && "ctrl", shift && "shift", named || lettered].filter(Boolean).join("+");
  return OF_BROWSER.includes(name) ? null : name;
}

const SCROLL = 50; // pixels for each event of the wheel

// keyboard, clipboard and mouse
function listen(terminal, send) {
  terminal.attachCustomKeyEventHandler((event) => {
    const text = event.type === "keydown" && keyName(event);
    if (text) { event.preventDefault(); send({ kind: "key", text }); }
    const types = [...event.key].length === 1 || ["Dead", "Process", "Unidentified"].includes(event.key);
    return types && !text && (event.getModifierState("AltGraph") || !(event.ctrlKey || event.metaKey));
  });
  terminal.onData((text) => { if (!text.startsWith("\x1b")) send({ kind: "type", text }); }); // else a reply of the terminal

  const place = $("terminal");
  place.addEventListener("paste", (event) => {
    event.preventDefault();
    event.stopPropagation();
    send({ kind: "paste", text: event.clipboardData.getData("text/plain") });
  }, true);

  const screen = terminal.element.querySelector(".xterm-screen");
  const within = (value, most) => Math.max(0, Math.min(most - 1, Math.floor(value)));
  let [pressed, last, scrolled] = [0, "", 0];
  function mouse(text, event) {
    const box = screen.getBoundingClientRect();
    const x = within(((event.clientX - box.left) / box.width) * terminal.cols, terminal.cols);
    const y = within(((event.clientY - box.top) / box.height) * terminal.rows, terminal.rows);
    if (text === "move" && last === `${x} ${y}`) return;
    last = `${x} ${y}`;
    const held = { shift: event.shiftKey, alt: event.altKey, ctrl: event.ctrlKey };
    send({ kind: "mouse", text, x, y, button: pressed, held });
  }
  // before xterm.js, which would select text
  place.addEventListener("mousedown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    event.stopPropagation();
    terminal.focus();
    pressed = 1;
    mouse("down", event);
  }, true);
  addEventListener("mouseup", (event) => {
    if (event.button !== 0 || !pressed) return;
    mouse("up", event);
    pressed = 0;
  }, true);
  addEventListener("mousemove", (event) => { if (pressed || place.contains(event.target)) mouse("move", event); });
  place.addEventListener("wheel", (event) => {
    event.preventDefault();
    event.stopPropagation();
    scrolled += event.deltaY * (event.deltaMode ? SCROLL / 2 : 1);
    for (; Math.abs(scrolled) >= SCROLL; scrolled -= Math.sign(scrolled) * SCROLL) mouse(scrolled < 0 ? "scroll up" : "scroll down", event);
  }, { capture: true, passive: false });
}

async function start() {
  const worker = new Worker(versioned("worker.js"), { type: "module" });
  const send = (message) => worker.postMessage(message);
  let terminal = null;
  let measured = "";

  // without `crossOrigin` offline.js could not tell whether these were loaded, and would not keep them
  const crossOrigin = "anonymous";
  const style = Object.assign(document.createElement("link"), { crossOrigin, rel: "stylesheet", href: versioned(settings.terminal["xterm.css"]) });
  const script = Object.assign(document.createElement("script"), { crossOrigin, src: versioned(settings.terminal["xterm.js"]) });
  worker.onerror = (event) => stop(event.message || "the worker failed");

  worker.onmessage = ({ data: { kind, text, content, share } }) => {
    if (kind === "write") terminal.write(text);
    else if (kind === "progress") { $("stage").textContent = text; $("progress").value = share; }
    else if (kind === "open") { document.title = `${text} – CALM`; $("loading").hidden = true; tell(""); terminal.focus(); }
    else if (kind === "saved") put(text, content, kind);
    else if (kind === "document") { put(text, content, kind); busy(false); }
    else if (kind === "told") tell(text);
    else if (kind === "copied") navigator.clipboard?.writeText(text).catch(() => {});
    else if (kind === "failed") { tell(text, true); busy(false); }
    else if (kind === "stopped") { $("loading").hidden = false; stop(text); }
  };

  await Promise.all([loaded(style), loaded(script)]);
  terminal = new globalThis.Terminal({
    fontFamily: '"DejaVu Sans Mono", "Liberation Mono", Menlo, Consolas, "Cascadia Mono", monospace',
    fontSize: 14, scrollback: 0, allowProposedApi: true, theme: { background: "#101418" },
  });
  terminal.open($("terminal"));
  listen(terminal, send);

  // the number of cells that fit
  function fit() {
    const screen = document.querySelector(".xterm-screen").getBoundingClientRect();
    const room = $("terminal");
    const columns = Math.max(40, Math.floor((room.clientWidth - 8) / (screen.width / terminal.cols)));
    const rows = Math.max(12, Math.floor((room.clientHeight - 4) / (screen.height / terminal.rows)));
    if (`${columns}×${rows}` !== measured) {
      measured = `${columns}×${rows}`;
      terminal.resize(columns, rows);
      send({ kind: "resize", columns, rows });
    }
  }
  new ResizeObserver(fit).observe($("terminal"));

  // the bar
  function button(place, title, message, hint = "") {
    const made = Object.assign(document.createElement("button"), { textContent: title, title: hint });
    made.onclick = () => { tell(""); send(message); terminal.focus(); };
    $(place).append(made);
    return made;
  }
  settings.actions.forEach(({ title, action }) => button("actions", title, { kind: "act", text: action }));
  const makers = settings.documents.map(({ kind, title }) => {
    const made = button("documents", title, { kind: "document", text: kind }, "Make it of the line and download it");
    made.addEventListener("click", () => { tell(`Making: ${title} …`); busy(true); });
    return made;
  });
  function busy(is) { makers.forEach((each) => { each.disabled = is; }); }

  settings.examples.forEach(({ file, title }) => $("examples").append(new Option(title, file)));
  $("examples").onchange = () => {
    if ($("examples").value) send({ kind: "example", text: $("examples").value });
    $("examples").value = "";
    terminal.focus();
  };
  $("new").onclick = () => { send({ kind: "new" }); terminal.focus(); };

  async function open(files) { if (files.length) send({ kind: "open", files: await contents([...files]) }); terminal.focus(); }
  $("open").onclick = async () => {
    if (!globalThis.showOpenFilePicker) { $("chosen").click(); return; }
    let chosen;
    try { chosen = await showOpenFilePicker({ multiple: true }); } catch { return; } // nothing was chosen
    const files = await Promise.all(chosen.map((each) => each.getFile()));
    chosen.forEach((each) => handles.set(each.name, each));
    await open(files);
  };
  $("chosen").onchange = async () => { await open($("chosen").files); $("chosen").value = ""; };

  const dropping = (is) => $("terminal").classList.toggle("dropping", is);
  addEventListener("dragover", (event) => { event.preventDefault(); dropping(true); });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) dropping(false); });
  addEventListener("drop", async (event) => {
    event.preventDefault();
    dropping(false);
    const files = [...event.dataTransfer.files];
    const asked = [...event.dataTransfer.items].map((each) => each.getAsFileSystemHandle?.());
    (await Promise.all(asked)).forEach((each) => { if (each?.kind === "file") handles.set(each.name, each); });
    await open(files);
  });

  fit();
  send({ kind: "start", settings, columns: terminal.cols, rows: terminal.rows });
  globalThis.calm = { send, terminal }; // for tests
}

start().catch((error) => stop(error.message));
