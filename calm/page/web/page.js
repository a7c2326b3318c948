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

async function start() {
  const worker = new Worker(versioned("worker.js"), { type: "module" });
  const send = (message) => worker.postMessage(message);
  let terminal = null;
  let measured = "";

  const style = Object.assign(document.createElement("link"), { rel: "stylesheet", href: versioned(settings.terminal["xterm.css"]) });
  const script = Object.assign(document.createElement("script"), { src: versioned(settings.terminal["xterm.js"]) });
  worker.onerror = (event) => stop(event.message || "the worker failed");

  worker.onmessage = ({ data: { kind, text, content, share } }) => {
    if (kind === "write") terminal.write(text);
    else if (kind === "progress") { $("stage").textContent = text; $("progress").value = share; }
    else if (kind === "open") { document.title = `${text} – CALM`; $("loading").hidden = true; terminal.focus(); }
    else if (kind === "saved") put(text, content, kind);
    else if (kind === "document") { put(text, content, kind); busy(false); }
    else if (kind === "told") tell(text);
    else if (kind === "failed") { tell(text, true); busy(false); }
    else if (kind === "stopped") { $("loading").hidden = false; stop(text); }
  };

  await Promise.all([loaded(style), loaded(script)]);
  terminal = new globalThis.Terminal({
    fontFamily: '"DejaVu Sans Mono", "Liberation Mono", Menlo, Consolas, "Cascadia Mono", monospace',
    fontSize: 14, scrollback: 0, allowProposedApi: true, theme: { background: "#101418" },
  });
  terminal.open($("terminal"));
  terminal.onData((text) => send({ kind: "type", text }));
  terminal.onBinary((text) => send({ kind: "type", text }));

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
    made.onclick = () => { send(message); terminal.focus(); };
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
