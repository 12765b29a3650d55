#!/usr/bin/env python3
"""Compares the sizes of compact files with gltfpack's: python3 compact_files.py BENDY FILE... [--gltfpack PATH] [--max-error 0.005%] [--keep-unused]

Prints a Markdown table of bytes without images, with and without clips. Both leave out what nothing uses, or keep it
(`--keep-unused`). Needs only Python 3.
"""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile


def chunks(data, at, end):
    """(id, offset, bytes with header and padding, is container) of each chunk, parents first."""
    while at < end:
        size_and_flags = struct.unpack_from('<Q', data, at + 8)[0]
        size, flags = size_and_flags & 0xffffffffffff, size_and_flags >> 48
        whole = 16 + size + -size % 16
        yield data[at:at + 4].decode(), at, whole, bool(flags & 1)
        at += whole


def bendy_bytes(path):
    """bytes without images, and the clips' bytes"""
    data = path.read_bytes()
    images = clips = 0
    open_chunks = [(0, len(data))]
    while open_chunks:
        for name, at, whole, is_container in chunks(data, *open_chunks.pop()):
            if name == 'IMAG':
                images += whole
            elif name == 'CYCL':
                clips += whole
            elif is_container:
                open_chunks.append((at + 16, at + whole))
    return len(data) - images, clips


def gltf_bytes(path):
    """The same of a .glb; the clips': their JSON and the buffer views that only they use."""
    data = path.read_bytes()
    size = struct.unpack_from('<I', data, 12)[0]
    gltf = json.loads(data[20:20 + size])
    views = gltf.get('bufferViews', [])

    def length(view):
        for extension in view.get('extensions', {}).values():
            if 'byteLength' in extension:
                return extension['byteLength']
        return view['byteLength']
    images = sum(length(views[image['bufferView']]) for image in gltf.get('images', []) if 'bufferView' in image)
    used = set()
    for animation in gltf.get('animations', []):
        for sampler in animation['samplers']:
            used |= {gltf['accessors'][sampler[key]].get('bufferView') for key in ('input', 'output')}
    clips = sum(length(views[view]) for view in used if view is not None)
    clips += len(json.dumps(gltf.get('animations', []), separators=(',', ':')))
    return len(data) - images, clips


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bendy', type=pathlib.Path)
    parser.add_argument('files', type=pathlib.Path, nargs='+')
    parser.add_argument('--gltfpack')
    parser.add_argument('--max-error', default='0.005%')
    parser.add_argument('--keep-unused', action='store_true', help='compare with gltfpack -kv')
    arguments = parser.parse_args()
    ours, theirs = ([], ['-kv']) if arguments.keep_unused else (['--drop-unused'], [])
    print('| file | exact | compact | without clips | gltfpack -cc | -cz | -cz without clips | compact / -cz | without clips |')
    print('|---|---|---|---|---|---|---|---|---|')
    for path in arguments.files:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)

            def convert(name, *options):
                out = folder / name
                done = subprocess.run([arguments.bendy, 'convert', path, '-q', '-o', out, *options], capture_output=True, text=True)
                if done.returncode != 0:
                    sys.exit(done.stderr)
                return bendy_bytes(out)
            exact = convert('exact.bendy')
            compact = convert('compact.bendy', '--max-error', arguments.max_error, *ours)
            cells = [path.stem, exact[0], compact[0], compact[0] - compact[1]]
            if arguments.gltfpack:
                packed = {}
                for option in ('-cc', '-cz'):
                    out = folder / ('packed%s.glb' % option)
                    done = subprocess.run([*arguments.gltfpack.split(), '-i', path, '-o', out, option, *theirs], capture_output=True, text=True)
                    packed[option] = gltf_bytes(out) if done.returncode == 0 else None
                if packed['-cc'] and packed['-cz']:
                    cz = packed['-cz']
                    cells += [packed['-cc'][0], cz[0], cz[0] - cz[1], '%.2f' % (compact[0] / cz[0]),
                              '%.2f' % ((compact[0] - compact[1]) / (cz[0] - cz[1]))]
            cells += [''] * (9 - len(cells))
            print('| ' + ' | '.join('{:,}'.format(c) if isinstance(c, int) else str(c) for c in cells) + ' |', flush=True)


if __name__ == '__main__':
    main()
