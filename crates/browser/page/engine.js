// One instance of the module. Requests and answers are lists of byte strings, the first of which is JSON. `host` reads
// dropped files and receives progress.
function engine(module, host) {
  let why = null;
  const bytes = (at, length) => new Uint8Array(exports.memory.buffer, at, length);
  const { exports } = new WebAssembly.Instance(module, {
    page: {
      read: (file, offset, into, length) => host.read(file, offset, bytes(into, length)),
      progress: (done, all) => host.progress(done >>> 0, all >>> 0),
      panicked: (at, length) => {
        why = new TextDecoder().decode(bytes(at, length).slice());
      },
    },
  });
  return (request, ...blobs) => {
    const parts = [new TextEncoder().encode(JSON.stringify(request)), ...blobs];
    const room = bytes(
      exports.room(parts.reduce((sum, part) => sum + part.length + 4, 0)),
      parts.reduce((sum, part) => sum + part.length + 4, 0),
    );
    let at = 0;
    for (const part of parts) {
      new DataView(room.buffer, room.byteOffset + at).setUint32(0, part.length, true);
      room.set(part, at + 4);
      at += part.length + 4;
    }
    let begin;
    try {
      begin = exports.answer();
    } catch (error) {
      throw new Error(
        why
          ? `the checker failed: ${why}; please report this`
          : `the checker failed: ${error.message}; the browser may have too little memory`,
      );
    }
    const answer = bytes(begin >>> 0, exports.length() >>> 0);
    const view = new DataView(answer.buffer, answer.byteOffset, answer.length);
    const found = [];
    for (let place = 0; place < answer.length;) {
      const length = view.getUint32(place, true);
      found.push(answer.slice(place + 4, place + 4 + length));
      place += 4 + length;
    }
    const value = JSON.parse(new TextDecoder().decode(found[0]));
    if (value.error) throw Object.assign(new Error(value.error), { isAnswer: true });
    return { value, parts: found.slice(1) };
  };
}
