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
const unpacked = (packed) => {
  const text = atob(packed.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i += 1) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
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
