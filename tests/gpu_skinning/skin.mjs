// Runs the passes of skinning.wgsl: each job is a mesh in a pose; the answer is ten floats for each of its vertices.
const send = (path, body) => fetch(path, { method: 'POST', body });
const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const { STORAGE, UNIFORM, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;

function bufferOf(device, bytes, usage = STORAGE | COPY_SRC) {
  const buffer = device.createBuffer({ size: Math.max(16, (bytes.length + 3) & ~3), usage, mappedAtCreation: true });
  new Uint8Array(buffer.getMappedRange()).set(bytes);
  buffer.unmap();
  return buffer;
}

function emptyBuffer(device, size, usage) {
  return device.createBuffer({ size: Math.max(16, size), usage });
}

async function pipelinesOf(device, code) {
  const module = device.createShaderModule({ code });
  const { messages } = await module.getCompilationInfo();
  if (messages.length > 0) throw new Error(messages.map((message) => `${message.lineNum}: ${message.message}`).join('\n'));
  const compute = (entryPoint) => device.createComputePipelineAsync({ layout: 'auto', compute: { module, entryPoint } });
  const colour = '@fragment fn colour(@location(2) normal: vec3f) -> @location(0) vec4f { return vec4f(normal, 1); }';
  const fragment = device.createShaderModule({ code: colour });
  const coords = { arrayStride: 8, attributes: [{ shaderLocation: 0, offset: 0, format: 'float32x2' }] };
  await device.createRenderPipelineAsync({ // compiles it; nothing is drawn
    layout: 'auto',
    vertex: { module, entryPoint: 'draw', buffers: [coords] },
    fragment: { module: fragment, entryPoint: 'colour', targets: [{ format: 'rgba8unorm' }] },
  });
  return { add: await compute('add_morph_target'), motions: await compute('make_motions'), skin: await compute('skin') };
}

function dispatch(device, encoder, pipeline, buffers, invocations) {
  const entries = buffers.map((buffer, binding) => ({ binding, resource: { buffer } }));
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
  pass.dispatchWorkgroups(Math.ceil(invocations / 64));
  pass.end();
}

async function skin(device, pipelines, job) {
  const make = (text, usage) => bufferOf(device, bytesOf(text), usage);
  const encoder = device.createCommandEncoder();
  const uniforms = make(job.parameters, UNIFORM);
  const streams = Object.fromEntries(Object.entries(job.streams).map(([name, text]) => [name, make(text)]));
  for (const morph of job.morphs) {
    const buffers = [make(morph.parameters, UNIFORM), make(morph.displaced), make(morph.displacements), streams[morph.stream]];
    dispatch(device, encoder, pipelines.add, buffers, morph.elements);
  }
  let transforms = make(job.palette);
  if (job.places !== undefined) {
    const motions = emptyBuffer(device, 80 * job.bones, STORAGE);
    dispatch(device, encoder, pipelines.motions, [uniforms, transforms, make(job.places), motions], job.bones);
    transforms = motions;
  }
  const skinned = emptyBuffer(device, 40 * job.vertices, STORAGE | COPY_SRC);
  const { positions, normals, tangents, bones, weights } = streams;
  dispatch(device, encoder, pipelines.skin, [uniforms, transforms, positions, normals, tangents, bones, weights, skinned], job.vertices);
  const read = emptyBuffer(device, skinned.size, MAP_READ | COPY_DST);
  encoder.copyBufferToBuffer(skinned, 0, read, 0, skinned.size);
  device.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  return read.getMappedRange().slice(0, 40 * job.vertices);
}

try {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw new Error('no WebGPU');
  const device = await adapter.requestDevice();
  device.addEventListener('uncapturederror', (event) => send('/failed/all', event.error.message));
  const pipelines = await pipelinesOf(device, await (await fetch('/files/0/skinning.wgsl')).text());
  for (const [number, job] of (await (await fetch('/jobs.json')).json()).entries()) {
    await send(`/result/${number}`, await skin(device, pipelines, job));
  }
} catch (problem) {
  await send('/failed/all', String(problem?.stack ?? problem));
}
await send('/done', '');
