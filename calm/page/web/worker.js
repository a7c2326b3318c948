// Python of the page: loads the runtime and CALM, then passes messages between the page and the builder.
const FOLDER = "/moorings";
// Pyodide's event loop fails with a task factory, which Textual sets.
const BEGIN = `
import asyncio
asyncio.get_event_loop().set_task_factory = lambda factory: None
from calm.page.builder import WebPage
WebPage
`;
const early = [];
let builder = null;
let python = null;

const post = (kind, text, content) => self.postMessage({ kind, text, content });
const begun = performance.now();
const progress = (text, share) => {
  console.info(`${((performance.now() - begun) / 1000).toFixed(1)} s: ${text}`);
  self.postMessage({ kind: "progress", text, share });
};

self.onmessage = ({ data }) => {
  if (data.kind === "start") start(data).catch(stopped);
  else if (builder) receive(data);
  else early.push(data);
};

// of Python's traceback, the line of the exception
function stopped(error) {
  console.error(error);
  const lines = String(error.message || error).trim().split("\n");
  post("stopped", lines.filter((line) => /^\w[\w.]*(Error|Exception)/.test(line)).at(-1) || lines.at(-1));
}

function receive(message) {
  const given = python.toPy(message);
  builder.receive(given);
  given.destroy();
}

async function fetched(name) {
  const answer = await fetch(name);
  if (!answer.ok) throw new Error(`${name} cannot be loaded (${answer.status})`);
  return answer.arrayBuffer();
}

async function start({ settings, columns, rows }) {
  const base = new URL(settings.runtime, self.location.href).href;
  progress("Loading Python …", 0.05);
  const archive = fetched(`${settings.archive.name}?v=${settings.built}`);
  const { loadPyodide } = await import(`${base}pyodide.mjs`);
  python = await loadPyodide({ indexURL: base, env: { HOME: FOLDER, TERM: "xterm-256color", COLORTERM: "truecolor" } });
  progress("Loading numerical libraries …", 0.4);
  await python.loadPackage(settings.packages, { messageCallback: () => {}, checkIntegrity: settings.runtime.startsWith("http") });
  progress("Unpacking CALM …", 0.6);
  const version = python.runPython("import sys; f'{sys.version_info[0]}.{sys.version_info[1]}'");
  python.unpackArchive(await archive, "zip", { extractDir: `/lib/python${version}/site-packages` });

  // the files of earlier visits, and unsaved work, in the IndexedDB of this browser
  python.FS.mkdirTree(FOLDER);
  python.FS.mount(python.FS.filesystems.IDBFS, {}, FOLDER);
  const reason = await synchronised(true);
  if (reason) console.info(`files are not kept: ${reason}`);
  else keepFiles();

  progress("Starting CALM …", 0.75);
  const toPage = (kind, text, content) => {
    let bytes = null;
    if (content) { bytes = content.toJs(); content.destroy(); }
    post(kind, text, bytes);
  };
  const make = python.runPython(BEGIN);
  builder = make(toPage, FOLDER, columns, rows);
  progress("Opening the line …", 0.95);
  early.splice(0).forEach(receive);
  await builder.run();
}

// after any change; what Python writes later than its answer to a message would otherwise be missed
async function keepFiles() {
  for (;;) {
    await new Promise((done) => setTimeout(done, 1000));
    await synchronised(false);
  }
}

function synchronised(fromBrowser) {
  return new Promise((done) => python.FS.syncfs(fromBrowser, done));
}
