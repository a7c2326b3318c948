// Keeps what the page has loaded, so that it works without a network.
const CACHE = `calm-${new URL(self.location.href).searchParams.get("v")}`;

// loaded before anything could be kept
const FIRST = ["./", "index.html", "page.css", "page.js", "page.json"];

self.addEventListener("install", (event) => {
  self.skipWaiting();
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(FIRST)));
});
self.addEventListener("activate", (event) => event.waitUntil((async () => {
  const old = (await caches.keys()).filter((name) => name.startsWith("calm-") && name !== CACHE);
  await Promise.all(old.map((name) => caches.delete(name)));
  await self.clients.claim();
})()));

self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || !request.url.startsWith("http")) return;
  const address = new URL(request.url);
  const isOwn = address.origin === self.location.origin;
  const isFixed = !isOwn || address.searchParams.has("v") || address.pathname.includes("/runtime/");
  event.respondWith(isFixed ? kept(request) : newest(request));
});

async function kept(request) {
  return (await caches.match(request)) || loaded(request);
}

// what may change from one visit to the next: the page and its settings
async function newest(request) {
  try {
    return await loaded(request);
  } catch (error) {
    const found = await caches.match(request, { ignoreSearch: request.mode === "navigate" });
    if (found) return found;
    throw error;
  }
}

async function loaded(request) {
  const answer = await fetch(request);
  if (answer.ok) (await caches.open(CACHE)).put(request, answer.clone());
  return answer;
}
