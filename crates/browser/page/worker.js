// The worker answers the requests one after the other. Each has the files that it may read.
let files = [],
  answerRequest = null,
  id = 0,
  lastReport = 0;
const host = {
  read(number, offset, into) {
    try {
      const piece = new FileReaderSync().readAsArrayBuffer(files[number].slice(offset, offset + into.length));
      into.set(new Uint8Array(piece));
      return piece.byteLength;
    } catch {
      return -1;
    }
  },
  progress(done, all) {
    const now = performance.now();
    if (now - lastReport < 100 && done < all) return;
    lastReport = now;
    postMessage({ id, progress: [done, all] });
  },
};
onmessage = ({ data }) => {
  id = data.id;
  try {
    answerRequest ??= engine(data.module, host);
    files = data.files;
    const { value, parts } = answerRequest(data.request, ...data.blobs);
    postMessage(
      { id, value, parts },
      parts.map((part) => part.buffer),
    );
  } catch (error) {
    // After a trap, the state of the module's memory is unknown.
    if (!error.isAnswer) answerRequest = null;
    postMessage({ id, error: error.message });
  }
};
