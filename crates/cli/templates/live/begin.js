"use strict";
// Another thread starts while the engine is read, most of the page, and unpacks it while the rest is.
const engineSource = URL.createObjectURL(new Blob([document.getElementById("worker").textContent], { type: "text/javascript" }));
const engineWorks = typeof WebAssembly === "object" && typeof DecompressionStream === "function";
const engineThread = engineWorks ? new Worker(engineSource) : null;
const engineModule = new Promise((resolve, reject) => {
  if (!engineThread) return;
  engineThread.onmessage = ({ data }) => (data.module ? resolve(data.module) : reject(data.failed));
});
