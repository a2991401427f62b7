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
// What comes while the engine is set up waits for it.
let ready = null;
onmessage = async ({ data }) => {
  try {
    if (data.module) {
      ready = WebAssembly.instantiate(data.module, {}).then((instance) => { engine = instance.exports; });
      return;
    }
    await ready;
    const begin = performance.now();
    const answer = ask(data.request);
    postMessage({ id: data.id, answer, seconds: (performance.now() - begin) / 1000 });
  } catch (error) {
    postMessage({ id: data.id, broken: String(error) });
  }
};
