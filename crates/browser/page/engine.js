// One instance of the module. Requests and answers are lists of byte strings, the first of which is JSON. `host` reads
// dropped files and receives progress.
function engine(module, host) {
  let panicMessage = null;
  const bytes = (offset, length) => new Uint8Array(exports.memory.buffer, offset, length);
  const { exports } = new WebAssembly.Instance(module, {
    page: {
      read: (file, offset, into, length) => host.read(file, offset, bytes(into, length)),
      progress: (done, all) => host.progress(done >>> 0, all >>> 0),
      panicked: (offset, length) => {
        panicMessage = new TextDecoder().decode(bytes(offset, length).slice());
      },
    },
  });
  return (request, ...blobs) => {
    const parts = [new TextEncoder().encode(JSON.stringify(request)), ...blobs];
    const input = bytes(
      exports.reserve_request(parts.reduce((sum, part) => sum + part.length + 4, 0)),
      parts.reduce((sum, part) => sum + part.length + 4, 0),
    );
    let offset = 0;
    for (const part of parts) {
      new DataView(input.buffer, input.byteOffset + offset).setUint32(0, part.length, true);
      input.set(part, offset + 4);
      offset += part.length + 4;
    }
    let answerAddress;
    try {
      answerAddress = exports.answer_request();
    } catch (error) {
      throw new Error(
        panicMessage
          ? `the checker failed: ${panicMessage}; please report this`
          : `the checker failed: ${error.message}; the browser may have too little memory`,
      );
    }
    const answer = bytes(answerAddress >>> 0, exports.length() >>> 0);
    const view = new DataView(answer.buffer, answer.byteOffset, answer.length);
    const answerParts = [];
    for (let position = 0; position < answer.length;) {
      const length = view.getUint32(position, true);
      answerParts.push(answer.slice(position + 4, position + 4 + length));
      position += 4 + length;
    }
    const value = JSON.parse(new TextDecoder().decode(answerParts[0]));
    if (value.error) throw Object.assign(new Error(value.error), { isAnswer: true });
    return { value, parts: answerParts.slice(1) };
  };
}
