"use strict";
// Another thread unpacks the engine while the page is read.
const engineSource = URL.createObjectURL(new Blob([document.getElementById("worker").textContent], { type: "text/javascript" }));
const engineWorks = typeof WebAssembly === "object" && typeof DecompressionStream === "function";
const engineThread = engineWorks ? new Worker(engineSource) : null;
const engineModule = new Promise((resolve, reject) => {
  if (!engineThread) return;
  engineThread.onmessage = ({ data }) => (data.module ? resolve(data.module) : reject(data.failed));
});
if (engineThread) engineThread.postMessage({ packed: document.getElementById("engine").textContent });
