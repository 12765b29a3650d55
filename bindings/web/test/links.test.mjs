// Where links in a file may lead: every address is parsed as a browser does, and a server sees what is asked for.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { test } from 'node:test';
import { LoadingManager, Texture } from 'three';
import { BendyLoader } from '../dist/three/index.js';
import { addressOfLink } from '../dist/three/links.js';
import { linking } from './helpers.mjs';

const inside = {
  'wood.png': 'wood.png',
  'a b.png': 'a%20b.png',
  '%41.png': '%41.png',
  '100%.png': '100%.png',
  ' wood.png ': 'wood.png',
  './sub/../wood.png': 'wood.png',
  'sub\\wood.png': 'sub/wood.png',
  './/elsewhere/x.png': '/elsewhere/x.png',
  './javascript:x': 'javascript:x',
  '..wood.png': '..wood.png',
  '.../wood.png': '.../wood.png',
  'wood.png?v=2': 'wood.png?v=2',
  'wood.png?../x#../y': 'wood.png?../x#../y',
  'HTTP://H:80/dir/wood.png': 'wood.png',
};
const outside = [
  '../x.png', '..', '../', '..?logout=1', '..#x', './../x.png', 'sub/../../x.png', '%2e%2e/x.png', '.%2E/x.png', '%2e%2e?x', '..\\x.png',
  'sub\\..\\..\\x.png', '..%2fx.png', 'sub/..%5c..%5cx.png', '%2e%2e%2fx.png', '/x.png', '\\x.png', '/dir/../x.png', '/directory/x.png', '//elsewhere/dir/x.png', '\\\\elsewhere/x.png',
  '/\\elsewhere/x.png', ' //elsewhere/x.png', 'http://elsewhere/x.png', ' http://elsewhere/x', 'https://h/dir/x.png', 'http:/x.png', 'http:../x.png', 'http:\\\\elsewhere', 'http://h:81/dir/x.png',
  'http://h@elsewhere/dir/x.png', 'http://me@h/dir/x.png', 'http://me:word@h/dir/x.png', 'ftp://h/dir/x.png', 'file:///dir/x.png', 'blob:http://h/x', 'javascript:x', 'about:blank',
  'wss://h/dir/x.png', '', '.', './', 'sub/', '?logout=1', '#x', './?logout=1', ' ', 'sub/?x', 'sub/..',
];
const withControls = [
  '.\t./.\n./private/x.png', '\thttp://elsewhere/x', '\nwood.png', 'wood.png\r', 'wo\0od.png', 'wood\x7f.png', 'wood\x85.png', 'data:image/png;base64,\niVBO', 'ht\ntp://elsewhere/x',
];

function atPage(address, act) {
  globalThis.document = { baseURI: address };
  try {
    act();
  } finally {
    delete globalThis.document;
  }
}

test('a link leads to a file in the folder, or nowhere', () => {
  for (const [page, path] of [
    ['http://h/dir/page.html?x=/y/', ''],
    ['http://h/other/page.html', '/dir/'],
    ['http://h/page.html', 'dir/'],
    ['http://h/dir/', './'],
    ['https://elsewhere/', 'http://h/dir/'],
    ['about:srcdoc', 'http://h/dir/'],
    ['http://h/', 'http://h/dir/fox.bendy?from=/a/'],
  ]) {
    atPage(page, () => {
      const whole = (address) => new URL(address, page.startsWith('about') ? undefined : page).href;
      for (const [link, name] of Object.entries(inside)) assert.equal(whole(addressOfLink(link, path, false)), `http://h/dir/${name}`, `${page} ${path} ${link}`);
      for (const link of outside) assert.throws(() => addressOfLink(link, path, false), /its link (leaves the folder|is not an address)/, `${page} ${path} ${link}`);
      for (const link of withControls) {
        assert.throws(() => addressOfLink(link, path, false), /control character/, JSON.stringify(link));
        assert.throws(() => addressOfLink(link, path, true), /control character/, JSON.stringify(link));
      }
      assert.equal(addressOfLink('data:image/png;base64,iVBO', path, false), 'data:image/png;base64,iVBO');
      assert.equal(addressOfLink(' DATA:,x', path, false), 'data:,x');
      assert.equal(whole(addressOfLink('../x.png', path, true)), 'http://h/x.png');
      assert.equal(addressOfLink('http://elsewhere/x.png', path, true), 'http://elsewhere/x.png');
    });
  }
});

test('a link into a folder that has no address of its own stays as it is, for a URL modifier', () => {
  for (const path of ['', 'models/', 'blob:http://h/']) {
    assert.equal(addressOfLink('red skin.png', path, false), `${path}red skin.png`);
    assert.equal(addressOfLink('sub/wood.png', path, false), `${path}sub/wood.png`);
    for (const link of outside) assert.throws(() => addressOfLink(link, path, false), /its link leaves/, `${path} ${link}`);
  }
  atPage('http://h/page.html', () => {
    assert.equal(addressOfLink('red skin.png', '', false), 'red skin.png');
    // The name alone would be an address of another kind.
    assert.equal(new URL(addressOfLink('./javascript:x', '', false), 'http://h/').href, 'http://h/javascript:x');
    assert.equal(new URL(addressOfLink('.//elsewhere/x.png', '', false), 'http://h/').href, 'http://h//elsewhere/x.png');
  });
  atPage('file:///home/me/page.html', () => {
    assert.equal(addressOfLink('wood.png', '', false), 'wood.png');
    for (const link of ['/home/x.png', '/home/me/../x.png', 'file://server/home/me/x.png', '//server/home/me/x.png']) assert.throws(() => addressOfLink(link, '', false), /leaves/, link);
  });
});

test('a server is asked for files in the folder only', async () => {
  const links = [...outside, ...withControls, 'wood.png', 'sub\\a b.png?v=2'].filter((link) => link !== '');
  const file = linking(links);
  const requests = [];
  const server = createServer((request, response) => {
    requests.push(request.url);
    response.writeHead(200, { connection: 'close' }).end(request.url === '/dir/fox.bendy' ? file : 'image');
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const address = `http://127.0.0.1:${server.address().port}/dir/`;
  const { createImageBitmap } = globalThis;
  globalThis.ProgressEvent ??= class extends Event {};
  globalThis.createImageBitmap = async () => ({ width: 1, height: 1 });
  const { warn } = console;
  console.warn = () => {};
  try {
    const { scene, warnings, model } = await new BendyLoader().loadAsync(`${address}fox.bendy`);
    assert.equal(scene.children.length > 0, true);
    assert.deepEqual(requests.splice(0).sort(), ['/dir/fox.bendy', '/dir/sub/a%20b.png?v=2', '/dir/wood.png']);
    assert.equal(warnings.length, links.length - 2);
    for (const line of warnings) assert.doesNotMatch(line, /\p{Cc}/u);
    model.dispose();
    // A handler of the program's own gets no other address.
    const asked = [];
    const manager = new LoadingManager().addHandler(/./, { loadAsync: async (url) => (asked.push(url), new Texture()) });
    (await new BendyLoader(manager).parseAsync(file, address)).model.dispose();
    assert.deepEqual(asked.map((url) => new URL(url).href).sort(), [`${address}sub/a%20b.png?v=2`, `${address}wood.png`]);
  } finally {
    console.warn = warn;
    globalThis.createImageBitmap = createImageBitmap;
    server.close();
  }
});
