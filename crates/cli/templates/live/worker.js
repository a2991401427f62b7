"use strict";
// The engine in its own thread: a request as JSON in, an answer as JSON out.
let engine = null;
const write = new TextEncoder();
const read = new TextDecoder();
const ask = (request) => {
  const text = write.encode(JSON.stringify(request));
  const place = engine.room(text.length);
  new Uint8Array(engine.memory.buffer, place, text.length).set(text);
  const length = engine.call();
  return JSON.parse(read.decode(new Uint8Array(engine.memory.buffer, engine.answered(), length)));
};
const decoded = (text) => {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const bytes = atob(text);
  return Uint8Array.from(bytes, (byte) => byte.charCodeAt(0));
};
const unpacked = (packed) => {
  const stream = new Blob([decoded(packed.trim())]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compileStreaming(new Response(stream, { headers: { "Content-Type": "application/wasm" } }));
};
// The page keeps the compiled engine for the threads that follow.
const begin = async ({ packed, module }) => {
  try {
    const compiled = module || await unpacked(packed);
    engine = (await WebAssembly.instantiate(compiled, {})).exports;
    if (packed) postMessage({ module: compiled });
  } catch (error) {
    postMessage({ failed: String(error) });
  }
};
// What comes while the engine is set up waits for it.
let ready = null;
onmessage = async ({ data }) => {
  if (!data.request) {
    ready = begin(data);
    return;
  }
  try {
    await ready;
    const begin = performance.now();
    const answer = ask(data.request);
    postMessage({ id: data.id, answer, seconds: (performance.now() - begin) / 1000 });
  } catch (error) {
    postMessage({ id: data.id, broken: String(error) });
  }
};
