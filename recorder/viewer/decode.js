// Decodes the data of a replay page. recorder/replay_data.h and recorder/coding.h describe it.
"use strict";

class ByteReader {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at;
  }

  number() {
    let value = 0, scale = 1, byte;
    do {
      byte = this.bytes[this.at++];
      value += (byte & 127) * scale;
      scale *= 128;
    } while (byte > 127);
    return value % 2 ? -(value + 1) / 2 : value / 2;
  }

  // Returns `rows` rows of `width` numbers.
  rows(width, rows) {
    const values = new Int32Array(rows * width);
    for (let start = 0; start < values.length; start += width) {
      const mode = this.bytes[this.at++], order = mode % 3, chained = mode >= 3;
      let difference = 0;
      for (let i = start; i < start + width; ++i) {
        difference = this.number() + (chained ? difference : 0);
        const before = order > 0 ? values[i - width] : 0;
        values[i] = difference + before + (order > 1 ? before - values[i - 2 * width] : 0);
      }
    }
    return values;
  }

  // Returns the vertices of `count` triangles.
  triangles(count) {
    const corners = new Uint32Array(3 * count), gates = [];
    let vertices = 0;
    const vertex = code => (code === 1 ? vertices++ : vertices + 1 - code);
    for (let i = 0; i < corners.length;) {
      if (gates.length === 0) {
        for (let k = 0; k < 3; ++k) corners[i + k] = vertex(this.number());
        for (let k = 0; k < 3; ++k) gates.push(corners[i + (k + 1) % 3], corners[i + k]);
        i += 3;
        continue;
      }
      const to = gates.pop(), from = gates.pop(), code = this.number();
      if (code === 0) continue;
      const third = vertex(code);
      corners.set([from, to, third], i);
      gates.push(third, to, from, third);
      i += 3;
    }
    return corners;
  }
}

// Returns the description of the runs, with the arrays decoded into it. Positions stay multiples of `step`.
async function decodeReplay(base64) {
  const packed = Uint8Array.from(atob(base64), character => character.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const length = new DataView(bytes.buffer).getUint32(0, true), arrays = 4 + length;
  const replay = JSON.parse(new TextDecoder().decode(bytes.subarray(4, arrays)));
  const at = offset => new ByteReader(bytes, arrays + offset);
  for (const mesh of replay.meshes) {
    mesh.corners = at(mesh.walk).triangles(mesh.triangles);
    mesh.lines = mesh.lineCount ? Uint32Array.from(at(mesh.lines).rows(2 * mesh.lineCount, 1)) : new Uint32Array(0);
    if (mesh.positions !== undefined) mesh.positions = at(mesh.positions).rows(3 * mesh.vertices, 1);
  }
  for (const run of replay.runs)
    for (const body of run.bodies) {
      body.mesh = replay.meshes[body.mesh];
      if (body.rigid) {
        body.origins = at(body.origins).rows(3, body.frames);
        body.turns = at(body.turns).rows(4, body.frames);
        continue;
      }
      body.positions = at(body.positions).rows(3 * body.mesh.vertices, body.frames);
      for (const channel of body.channels) channel.levels = at(channel.levels).rows(body.mesh.vertices, body.frames);
    }
  return replay;
}
