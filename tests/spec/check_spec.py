#!/usr/bin/env python3
"""Holds the specification against the code: python3 check_spec.py [SOURCE_DIR]

Compares the tables of format/ (chunk_ids.def, records.def, error_codes.def, limits.h, the
flags of chunk.h, the stream rules of mesh.cpp, and references.def of format/extensions/) with the tables of spec/, in both directions, those of the grammar files
bendy.ksy and bendy.hexpat among them; follows the links between pages; and asks the scripts of spec/ whether their dumps and files are what they make now. One line for each difference; exit 1 if
there is one. Python 3, nothing else.
"""

import ast
import json
import pathlib
import re
import subprocess
import sys

SIZES = {'u8': 1, 'u16': 2, 'u32': 4, 'u64': 8, 'f32': 4}


class Check:
    def __init__(self, source):
        self.source = source
        self.spec = source / 'spec'
        self.include = source / 'format' / 'include' / 'bendy' / 'format'
        self.differences = 0
        self.comparisons = 0

    def fail(self, page, message):
        self.differences += 1
        print('%s: %s' % (page, message))

    def same(self, page, what, in_spec, in_code):
        self.comparisons += 1
        if in_spec != in_code:
            self.fail(page, '%s: the page has %s, the code %s' % (what, show(in_spec), show(in_code)))

    def same_keys(self, page, what, in_spec, in_code):
        self.comparisons += 1
        for key in in_code:
            if key not in in_spec:
                self.fail(page, '%s %s is in the code and missing here' % (what, show(key)))
        for key in in_spec:
            if key not in in_code:
                self.fail(page, '%s %s is here and not in the code' % (what, show(key)))

    def code(self, name):
        return (self.include / name).read_text(encoding='utf-8')

    def page(self, name):
        path = self.spec / name
        if not path.is_file():
            self.fail('spec/' + name, 'the page is missing')
            return ''
        return path.read_text(encoding='utf-8')

    def understood(self, found, where):
        if not found:
            sys.exit('check_spec: nothing was found in %s: its form has changed, teach check_spec.py the new one' % where)
        return found


def show(value):
    if isinstance(value, (tuple, list, set)):
        return ' '.join(str(part) for part in (sorted(value) if isinstance(value, set) else value)) or 'nothing'
    return str(value)


# --- the code's tables -----------------------------------------------------------------------------------------------

def strip_comments(code):
    return re.sub(r'//[^\n]*', '', code)


def read_chunks(check):
    """id -> shape, parents, times, what"""
    pattern = r'^BENDY_CHUNK\(\s*(\w{4}),\s*(\w+),\s*"([^"]*)",\s*(\w+),\s*"([^"]*)"\s*\)'
    chunks = {}
    for chunk, shape, parents, times, what in re.findall(pattern, check.code('chunk_ids.def'), re.MULTILINE):
        chunks[chunk] = {'shape': shape, 'parents': set() if parents == '-' else set(parents.split()), 'times': times,
                         'what': what}
    return check.understood(chunks, 'chunk_ids.def')


def read_records(check):
    """struct -> chunk, shortest, [(offset, type, count, field)]"""
    code = check.code('records.def')
    records = {}
    for chunk, struct, shortest in re.findall(r'^BENDY_RECORD\(\s*(\w+),\s*(\w+),\s*(\d+)\s*\)', code, re.MULTILINE):
        records[struct] = {'chunk': chunk, 'shortest': int(shortest), 'fields': []}
    fields = re.findall(r'^BENDY_FIELD\(\s*(\w+),\s*(\w+),\s*(\w+),\s*(\d+),\s*(\d+),', code, re.MULTILINE)
    for struct, field, kind, count, offset in fields:
        records[struct]['fields'].append((int(offset), kind, int(count), field))
    check.understood(fields, 'records.def')
    lines = len(re.findall(r'^BENDY_FIELD\(', code, re.MULTILINE))
    check.understood(lines == len(fields), 'some lines of records.def')
    return records


def size_of(struct, records):
    offset, kind, count, _ = max(records[struct]['fields'])
    return offset + count * (SIZES[kind] if kind in SIZES else size_of(kind, records))


def read_constants(check):
    def value(expression):
        expression = re.sub(r'std::uint\d+_t\{(\w+)\}', r'\1', expression).replace("'", '')
        if re.fullmatch(r'[\d.e-]+f', expression):
            return float(expression[:-1])
        check.understood(re.fullmatch(r'[0-9a-fx()<\-+* ]+', expression), 'the constant ' + expression)
        return eval(expression)  # digits and operators only, see above
    pattern = r'inline constexpr [\w:]+ (k\w+) = ([^;]+);'
    limits = {name: value(text) for name, text in re.findall(pattern, check.code('limits.h'))}
    tolerances = {}
    for header in ('mesh.h', 'clip.h', 'joint.h'):
        tolerances.update({name: value(text) for name, text in re.findall(pattern, check.code(header)) if 'Tolerance' in name})
    return check.understood(limits, 'limits.h'), check.understood(tolerances, 'the tolerances of mesh.h and clip.h')


def read_stream_rules(check):
    """(parent, chunk) -> forms: (types, fewest, most, numbers)"""
    code = ' '.join(strip_comments((check.source / 'format' / 'src' / 'mesh.cpp').read_text(encoding='utf-8')).split())
    limits, _ = read_constants(check)
    rules = {}
    for rule, body in re.findall(r'constexpr StreamForm (k\w+)\[\] = \{\s*(\{.*?\})\s*\};', code):
        rules[rule] = []
        for types, fewest, most, numbers in re.findall(r'\{any_of\(([^)]*)\), (\w+), (\w+), (\w+)\}', body):
            width = [str(limits[n] if n in limits else int(n, 0)) for n in (fewest, most)]
            rules[rule].append((' '.join(types.split(', ')), *width, numbers))
    check.understood(rules, 'the StreamForm constants of mesh.cpp')
    uses = {}
    for container, chunk, rule in re.findall(r'find\((\w+), FourCC\("(\w{4})"\), forms::(k\w+)', code):
        parent = {'chunk': 'VECT', 'block': 'FRMS', 'number': 'USER' if chunk == 'VALS' else 'TARG'}[container]
        uses[parent, chunk] = rules[rule]
    for chunk, rule in re.findall(r'id == FourCC\("(\w{4})"\)\) \{ const auto \w+ = reader\.stream\(number, forms::(k\w+)', code):
        uses['VECT', chunk] = rules[rule]
    for rule in re.findall(r'stream\(index_chunk, forms::(k\w+)', code):
        uses['TARG', 'INDX'] = rules[rule]
    check.understood(len(uses) >= 13, 'all uses of the StreamForm constants of mesh.cpp')
    return uses


# --- the pages' tables -----------------------------------------------------------------------------------------------

def tables(page):
    """Every table of a page: (the text line before it, header cells, rows of cells)."""
    lines = page.splitlines()
    at = 0
    while at < len(lines):
        if not lines[at].startswith('|'):
            at += 1
            continue
        before = next((line for line in reversed(lines[:at]) if line.strip()), '')
        start = at
        while at < len(lines) and lines[at].startswith('|'):
            at += 1
        rows = [[cell.strip() for cell in line.strip().strip('|').split('|')] for line in lines[start:at]]
        yield before, rows[0], rows[2:]


def parents_of_path(path):
    steps = path.split('/')
    last = steps[-1].rstrip('+')
    parents = {steps[-2].rstrip('+')} if len(steps) > 1 else set()
    if steps[-1].endswith('+'):
        parents.add(last)
    return parents


def check_chunk_pages(check, chunks):
    pages = {path.stem for path in (check.spec / 'chunks').glob('*.md')}
    check.same_keys('spec/chunks', 'page', sorted(pages), sorted(chunks))
    limits, _ = read_constants(check)
    for chunk in sorted(pages & set(chunks)):
        name = 'spec/chunks/%s.md' % chunk
        rule = chunks[chunk]
        page = check.page('chunks/%s.md' % chunk)
        check.same(name, 'title', page.splitlines()[0], '# %s: %s' % (chunk, rule['what']))
        facts = {}
        for _, header, rows in tables(page):
            if header == ['', '']:
                facts = {row[0]: row[1] for row in rows}
                break
        check.same_keys(name, 'fact', list(facts), ['path', 'shape', 'occurs', 'since'])
        check.same(name, 'shape', facts.get('shape'), rule['shape'])
        check.same(name, 'occurs', facts.get('occurs'), rule['times'])
        since = re.fullmatch(r'(\d+)\.(\d+)', facts.get('since', ''))
        if not since:
            check.fail(name, 'since is not like "0.1"')
        else:
            now = (limits['kVersionMajor'], limits['kVersionMinor'])
            if (int(since[1]), int(since[2])) > now:
                check.fail(name, 'since %s.%s is later than the version, %d.%d' % (since[1], since[2], *now))
        parents = set()
        for path in re.findall(r'`([^`]+)`', facts.get('path', '')):
            steps = path.split('/')
            if steps[-1].rstrip('+') != chunk or steps[0] != 'HEAD':
                check.fail(name, 'the path %s does not lead from HEAD to %s' % (path, chunk))
            for parent, child in zip(steps, steps[1:]):
                if parent.rstrip('+') not in chunks.get(child.rstrip('+'), {'parents': ()})['parents']:
                    check.fail(name, 'on the path %s, %s may not stand in %s' % (path, child, parent))
            parents |= parents_of_path(path)
        check.same(name, 'parents', parents, rule['parents'])
        has_example = '<!-- make_bytes: chunk %s -->' % chunk in page
        check.same(name, 'has an example', has_example, True)


def check_index(check, chunks):
    rows = {}
    for _, header, body in tables(check.page('README.md')):
        if header == ['chunk', 'what', 'in', 'occurs']:
            for chunk, what, parents, times in body:
                link = re.fullmatch(r'\[(\w+)\]\(chunks/(\w+)\.md\)', chunk)
                if not link or link[1] != link[2]:
                    check.fail('spec/README.md', 'the index has %s for a link' % chunk)
                    continue
                rows[link[1]] = (what, set() if parents == 'the root' else set(parents.split()), times)
    check.same_keys('spec/README.md', 'chunk', list(rows), list(chunks))
    for chunk in rows.keys() & chunks.keys():
        rule = chunks[chunk]
        for what, in_spec, in_code in zip(('what', 'parents', 'occurs'), rows[chunk], (rule['what'], rule['parents'], rule['times'])):
            check.same('spec/README.md', '%s of %s' % (what, chunk), in_spec, in_code)


def check_tree(check, chunks):
    name = 'spec/tree.md'
    block = re.search(r'```\n(HEAD.*?)```', check.page('tree.md'), re.DOTALL)
    if not block:
        check.fail(name, 'the tree is missing')
        return
    marks = {'': 'one', '?': 'optional', '*': 'many'}
    edges = set()
    open_chunks = []
    for line in block[1].splitlines():
        entry = re.match(r'( *)(\w{4})([?*]?)(?:\s|$)', line)
        if not entry or len(entry[1]) % 2 or len(entry[1]) // 2 > len(open_chunks):
            check.fail(name, 'cannot read the line: ' + line)
            continue
        depth = len(entry[1]) // 2
        del open_chunks[depth:]
        if depth:
            edges.add((open_chunks[-1], entry[2], marks[entry[3]]))
        open_chunks.append(entry[2])
    expected = {(parent, chunk, rule['times']) for chunk, rule in chunks.items() for parent in rule['parents']}
    check.same_keys(name, 'line', sorted(edges), sorted(expected))


def check_records(check, records):
    found = {}
    for path in sorted(check.spec.glob('**/*.md')):
        name = path.relative_to(check.source).as_posix()
        for before, header, rows in tables(path.read_text(encoding='utf-8')):
            if header != ['offset', 'type', 'count', 'field', 'meaning']:
                continue
            caption = re.fullmatch(r'`(\w+)`: (\d+) bytes(?:, the first (\d+) needed)?(, repeated to the end of the payload)?\.', before)
            if not caption:
                check.fail(name, 'a field table has no caption like "`RestRecord`: 52 bytes, the first 40 needed."')
                continue
            struct = caption[1]
            if struct in found:
                check.fail(name, '%s stands here and in %s' % (struct, found[struct]))
            found[struct] = name
            if struct not in records:
                continue
            record = records[struct]
            place = 'spec/streams.md' if struct == 'StreamRecord' else 'spec/chunks/%s.md' % record['chunk']
            check.same(name, 'page of ' + struct, name, place)
            total = size_of(struct, records)
            check.same(name, 'size of ' + struct, int(caption[2]), total)
            is_alone = sum(other['chunk'] == record['chunk'] for other in records.values()) == 1
            needed = 0 if caption[4] and is_alone else int(caption[3] or caption[2])
            check.same(name, 'needed bytes of ' + struct, needed, record['shortest'])
            in_spec = {row[3]: (row[0], row[1], row[2]) for row in rows if len(row) == 5}
            in_code = {field: (str(offset), kind, str(count)) for offset, kind, count, field in record['fields']}
            if len(in_spec) != len(rows):
                check.fail(name, 'a row of %s has not five cells, or names a field twice' % struct)
            check.same_keys(name, 'field of %s:' % struct, list(in_spec), list(in_code))
            check.same(name, 'order of %s' % struct, [f for f in in_spec if f in in_code], [f for f in in_code if f in in_spec])
            for field in in_spec.keys() & in_code.keys():
                for what, a, b in zip(('offset', 'type', 'count'), in_spec[field], in_code[field]):
                    check.same(name, '%s of %s.%s' % (what, struct, field), a, b)
            for row in rows:
                if len(row) == 5 and not row[4]:
                    check.fail(name, '%s.%s has no meaning' % (struct, row[3]))
    check.same_keys('spec', 'record', list(found), list(records))


def check_quick(check, chunks, records):
    """The records that quick.md repeats in short, '16 f32[3] translation' in a table of its own; the ids that its readers know."""
    name = 'spec/quick.md'
    found = set()
    for _, header, rows in tables(check.page('quick.md')):
        if header != ['chunk', 'record', 'bytes', 'fields']:
            continue
        for chunk, struct, size, fields in rows:
            found.add(struct)
            if struct not in records:
                check.fail(name, '%s is no record' % struct)
                continue
            if chunk != 'streams':
                check.same(name, 'chunk of ' + struct, chunk, records[struct]['chunk'])
            needed = records[struct]['shortest'] or size_of(struct, records)
            check.same(name, 'bytes of ' + struct, int(re.match(r'\d+', size)[0]), needed)
            code = {field: (offset, kind, count) for offset, kind, count, field in records[struct]['fields']}
            for field in fields.split('; '):
                part = re.match(r'(\d+) (\w+)(?:\[(\d+)\])? (\w+)', field)
                in_spec = (int(part[1]), part[2], int(part[3] or 1)) if part else field
                check.same(name, '%s.%s' % (struct, part[4] if part else field), in_spec, code.get(part[4]) if part else None)
    check.understood(found, 'quick.md')
    for name in ('spec/readers/quick_reader.py', 'spec/readers/quick_reader.c'):
        known = re.search(r'"(HEAD VERS [A-Z" \n]*)"', (check.source / name).read_text(encoding='utf-8'))
        check.understood(known, name)
        check.same_keys(name, 'id', re.findall(r'[A-Z]{4}', known[1]), list(chunks))


def enumerations(check):
    """enumeration -> [names in order of their values]"""
    code = {enum: names.split(', ') for enum, names in
            re.findall(r'^BENDY_VALUES\((\w+), k\w+, ([\w, ]+)\)$', check.code('records.def'), re.MULTILINE)}
    lines = len(re.findall(r'^BENDY_VALUES\(', check.code('records.def'), re.MULTILINE))
    check.understood(code and lines == len(code), 'the enumerations of records.def')
    return code


def check_enumerations(check):
    code = enumerations(check)
    spec = {}
    for path in sorted(check.spec.glob('**/*.md')):
        for _, header, rows in tables(path.read_text(encoding='utf-8')):
            if header[0] == 'value' and header[1] in code:
                name = path.relative_to(check.source).as_posix()
                spec[header[1]] = [row[1] for row in rows]
                check.same(name, 'values of ' + header[1], [row[0] for row in rows], [str(k) for k in range(len(rows))])
                check.same(name, 'names of ' + header[1], spec[header[1]], code[header[1]])
                if header[1] == 'ComponentType':
                    sizes = re.search(r'kSizes\{([\d, ]+)\}', check.code('records.h'))
                    check.understood(sizes, 'component_size of records.h')
                    check.same(name, 'bytes of ComponentType', [row[2] for row in rows], re.findall(r'\d+', sizes[1]))
    check.same_keys('spec', 'enumeration', list(spec), list(code))
    roles = json.loads((check.spec / 'rig.schema.json').read_text(encoding='utf-8'))['properties']['roles']
    check.same('spec/rig.schema.json', 'roles', roles['propertyNames']['enum'], code['Role'][1:])  # without none


def check_leaves(check, chunks, records):
    """Every leaf has parts; types, and the fields that columns name, are there."""
    rows = re.findall(r'^BENDY_PART\("([^"]*)", +(\w+), +"(\w*)", +(\w+), +"([^"]*)", +"([^"]*)", +"(\w+)", *(\w+), +(\w+), +(\w+), +"[^"]*"\)$',
                      check.code('leaf_parts.def'), re.MULTILINE)
    check.understood(len(rows) == len(re.findall(r'^BENDY_PART\(', check.code('leaf_parts.def'), re.MULTILINE)), 'some lines of leaf_parts.def')
    heads = {leaf: kind for leaves, part, _, kind, *_ in rows if part == 'record' for leaf in leaves.split()}
    check.same_keys('leaf_parts.def', 'leaf', sorted({leaf for row in rows for leaf in row[0].split()}),
                    sorted(chunk for chunk, rule in chunks.items() if rule['shape'] == 'leaf'))
    for leaves, part, name, kind, count, when, row, *_ in rows:
        for leaf in leaves.split():
            fields = {field for _, _, _, field in records[heads[leaf]]['fields']} if leaf in heads else set()
            words = set(re.findall(r'[a-z]\w*', count.replace('rest', '') + ' ' + when + ' ' + row))
            check.same('leaf_parts.def', 'fields that %s of %s needs' % (name or 'record', leaf), words - fields, set())
            is_type = kind in records or kind in fields or kind in (*SIZES, 'i8', 'i16', 'i32', 'JointSubmesh')
            if leaf != 'MARK':  # whose record is not in the text form
                check.same('leaf_parts.def', 'fields of %s that are called as a part' % leaf, fields & {name}, set())
            check.same('leaf_parts.def', 'type of %s of %s is known' % (name or 'record', leaf), is_type, True)


def check_streams(check):
    name = 'spec/streams.md'
    spec = {}
    for _, header, rows in tables(check.page('streams.md')):
        if header[:5] == ['chunk', 'in', 'types', 'components', 'numbers']:
            for chunk, parent, types, components, numbers, *_ in rows:
                fewest, _, most = components.partition('–')
                forms = spec.setdefault((parent, re.sub(r'\[(\w+)\].*', r'\1', chunk)), [])
                forms.append((types, fewest, most or fewest, numbers))
    code = read_stream_rules(check)
    check.same_keys(name, 'stream', sorted(spec), sorted(code))
    for key in spec.keys() & code.keys():
        check.same(name, 'forms of %s in %s' % (key[1], key[0]), spec[key], code[key])


def check_codes(check):
    name = 'spec/diagnostics.md'
    pattern = r'^BENDY_ERROR\(\s*\w+,\s*(\w+),\s*"(\w+)",\s*"([^"]*)"\s*\)'
    code = {c: (kind, text) for kind, c, text in re.findall(pattern, check.code('error_codes.def'), re.MULTILINE)}
    check.understood(code, 'error_codes.def')
    check.understood(len(code) == len(re.findall(r'^BENDY_ERROR\(', check.code('error_codes.def'), re.MULTILINE)), 'some lines of error_codes.def')
    spec = {}
    for _, header, rows in tables(check.page('diagnostics.md')):
        if header == ['code', 'class', 'text', 'what to do']:
            for row in rows:
                if len(row) != 4 or not row[3]:
                    check.fail(name, '%s does not say what to do' % row[0])
                    continue
                if row[0].strip('`') in spec:
                    check.fail(name, '%s stands twice' % row[0])
                spec[row[0].strip('`')] = (row[1], row[2])
    check.same_keys(name, 'code', list(spec), list(code))
    for key in spec.keys() & code.keys():
        for what, a, b in zip(('class', 'text'), spec[key], code[key]):
            check.same(name, '%s of %s' % (what, key), a, b)
    steps = [code for _, header, rows in tables(check.page('diagnostics.md')) if header == ['step', 'codes'] for row in rows for code in row[1].replace('`', '').split()]
    check.same(name, 'codes of the steps', sorted(steps), sorted(c for c, (kind, _) in code.items() if kind != 'io'))
    used = set()
    for path in sorted(check.spec.glob('**/*.md')):
        if path.name == 'diagnostics.md':
            continue
        words = set(re.findall(r'`([A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*)`', path.read_text(encoding='utf-8')))
        used |= words & set(code)
        for word in sorted(words - set(code)):
            if '_' in word:
                check.fail(path.relative_to(check.source).as_posix(), '%s is no code of error_codes.def' % word)
    for key, (kind, _) in code.items():
        if kind != 'io' and key not in used:
            check.fail('spec', 'no page but diagnostics.md says when %s comes' % key)


def check_constraints_of(check):
    name = 'spec/limits.md'
    limits, tolerances = read_constants(check)
    code = {**limits, **tolerances}
    spec = {}
    for _, header, rows in tables(check.page('limits.md')):
        if header == ['constant', 'value', 'meaning']:
            spec.update({row[0]: row[1] for row in rows})
    check.same_keys(name, 'constant', list(spec), list(code))
    for key in spec.keys() & code.keys():
        try:
            value = float(spec[key]) if isinstance(code[key], float) else int(spec[key])
        except ValueError:
            value = spec[key]
        check.same(name, key, value, code[key])
    version = '%d.%d' % (limits['kVersionMajor'], limits['kVersionMinor'])
    for page, pattern in (('README.md', r'^Version \*\*([\d.]+)\*\*'), ('versions.md', r'This specification describes version \*\*([\d.]+)\*\*')):
        found = re.search(pattern, check.page(page), re.MULTILINE)
        check.same('spec/' + page, 'version', found[1] if found else 'none', version)


THINGS = {'joint': 'joint', 'mesh': 'mesh', 'material': 'material', 'texture': 'texture', 'image': 'image',
          'target_of_joint': 'target of the joint `%s`', 'target_of_mesh': 'target of the mesh `%s`', 'element': 'element of `%s`',
          'rows_of_materials': 'one element for each material'}
GONE = {'entry': 'entry', 'entry_or_list': 'entry, and an emptied list', 'member': 'member', 'all': 'extension', 'minus_one': '-1'}


def check_references(check):
    name = 'spec/rig.md'
    table = (check.source / 'format/extensions/include/bendy/extensions/references.def').read_text(encoding='utf-8')
    lines = re.findall(r'^BENDY_REFERENCE\("(\w+)", (\w+), "([^"]*)", (\w+), "([^"]*)", (\w+)\)$', table, re.MULTILINE)
    check.understood(lines and len(lines) == len(re.findall(r'^BENDY_REFERENCE', table, re.MULTILINE)), 'references.def')
    addon = 'bindings/blender/bendy_rig/references.py'
    copied = re.search(r'^REFERENCES = (\(.*?^\))$', (check.source / addon).read_text(encoding='utf-8'), re.MULTILINE | re.DOTALL)
    check.same(addon, 'the table of references.def', ast.literal_eval(copied[1]) if copied else None, tuple(lines))
    code = {}
    for extension, host, path, thing, beside, gone in lines:
        number = THINGS[thing] % beside if '%s' in THINGS[thing] else THINGS[thing]
        code['`%s` of %s: `%s`' % (extension, host, path)] = (number, GONE[gone])
    spec = {}
    for _, header, rows in tables(check.page('rig.md')):
        if header == ['extension', 'of', 'member', 'number of', 'taken out']:
            spec.update({'%s of %s: %s' % (row[0], row[1], row[2]): (row[3], row[4]) for row in rows})
    check.same_keys(name, 'reference', list(spec), list(code))
    for key in spec.keys() & code.keys():
        check.same(name, key, spec[key], code[key])


def check_gltf_extensions(check):
    """The tables of gltf.md name the members, and the words, of the schemas, which make_gltf_schema.py makes."""
    schemas = {'constraint': 'node.BENDY_joint_limits', 'role': 'node.BENDY_joint_role', 'chain': 'glTF.BENDY_ik_chains',
               'standing_pose': 'glTF.BENDY_standing_pose'}
    found = {}
    for before, _, rows in tables(check.page('gltf.md')):
        marked = re.fullmatch(r'<!-- members: (\w+) -->', before)
        if marked:
            found[marked[1]] = rows
    check.same_keys('spec/gltf.md', 'table', sorted(found), sorted(schemas))
    for kind in found.keys() & schemas.keys():
        schema = json.loads((check.spec / 'gltf' / (schemas[kind] + '.schema.json')).read_text(encoding='utf-8'))['$defs'][kind]
        members = {name: row[1] for row in found[kind] for name in re.findall(r'`(\w+)`', row[0])}
        check.same_keys('spec/gltf.md', 'member of a ' + kind, sorted(members), sorted(schema['properties']))
        for name in members.keys() & schema['properties'].keys():
            words = schema['properties'][name].get('enum')
            if words:
                named = [word for word in re.findall(r'`(\w+)`', members[name]) if word in words]
                check.same('spec/gltf.md', 'words of ' + name, sorted(set(named)), sorted(words))


def check_flags(check):
    name = 'spec/grammar.md'
    masks = {}
    pattern = r'k(\w+?)(?:Flags?|Mask) = (?:1u << (\d+)|0x([0-9a-f]+)u),'
    for flag, shift, mask in re.findall(pattern, check.code('chunk.h')):
        masks[flag.lower()] = 1 << int(shift) if shift else int(mask, 16)
    check.understood(masks, 'the flags of chunk.h')
    spec = {}
    for _, header, rows in tables(check.page('grammar.md')):
        if header == ['bits', 'name', 'meaning']:
            for bits, flag, _ in rows:
                first, _, last = bits.partition('–')
                spec[flag.lower()] = sum(1 << bit for bit in range(int(first), int(last or first) + 1))
    check.same_keys(name, 'flag', list(spec), list(masks))
    for flag in spec.keys() & masks.keys():
        check.same(name, 'bits of ' + flag, hex(spec[flag]), hex(masks[flag]))


def snake(name):
    return re.sub(r'(?<!^)([A-Z])', r'_\1', name).lower()


def check_grammar_records(check, name, found, records):
    """found: struct -> [(field, type, count)] as a grammar file has it, types spelt as in records.def."""
    check.same_keys(name, 'record', list(found), list(records))
    for struct in found.keys() & records.keys():
        offset = 0
        for stated, kind, count, field in records[struct]['fields']:
            check.same(name, 'offset of %s.%s' % (struct, field), offset, stated)
            offset += count * (SIZES[kind] if kind in SIZES else size_of(kind, records))
        fields = [(field, kind, count) for _, kind, count, field in records[struct]['fields']]
        check.same(name, 'fields of ' + struct, ['%s %s %d' % f for f in found[struct]], ['%s %s %d' % f for f in fields])


def check_grammar_enumerations(check, name, found):
    """found: enumeration, in small letters, -> [names in order of their values]."""
    code = {snake(enum): names for enum, names in enumerations(check).items()}
    check.same_keys(name, 'enumeration', list(found), list(code))
    for enum in found.keys() & code.keys():
        check.same(name, 'names of ' + enum, found[enum], code[enum])


def check_grammar_ids(check, name, containers, leaves, chunks):
    check.same_keys(name, 'container', sorted(containers), sorted(c for c, rule in chunks.items() if rule['shape'] == 'container'))
    check.same_keys(name, 'leaf', sorted(leaves), sorted(c for c, rule in chunks.items() if rule['shape'] == 'leaf'))


def check_kaitai(check, chunks, records):
    name = 'spec/bendy.ksy'
    text = check.page('bendy.ksy')
    kinds = {'u1': 'u8', 'u2': 'u16', 'u4': 'u32', 'u8': 'u64', 'f4': 'f32', **{snake(struct): struct for struct in records}}
    structs = {snake(struct): struct for struct in records}
    found, docs = {}, {}
    for record, body in re.findall(r'^  (\w+_record):\n    seq:\n((?:      - .*\n)+)', text, re.MULTILINE):
        struct = structs.get(record, record)
        found[struct] = []
        for line in body.splitlines():
            field = re.search(r'\{id: (\w+),', line)
            bytes_of = re.search(r' size: (\d+),', line)
            kind = re.search(r' type: (\w+),', line)
            count = re.search(r' repeat-expr: (\d+),', line)
            doc = re.search(r' doc: "([^"]*)"\}$', line)
            if not field or not doc or not (kind or bytes_of):
                check.fail(name, 'cannot read the line: ' + line)
                continue
            found[struct].append((field[1], 'u8' if bytes_of else kinds.get(kind[1], kind[1]), int((bytes_of or count or [0, 1])[1])))
            docs[struct, field[1]] = doc[1]
    check_grammar_records(check, name, found, records)
    for struct, field, what in re.findall(r'^BENDY_FIELD\(\s*(\w+),\s*(\w+),[^"]*"([^"]*)"', check.code('records.def'), re.MULTILINE):
        check.same(name, 'doc of %s.%s' % (struct, field), docs.get((struct, field)), what)
    enums = re.findall(r'^  (\w+): \{(0: [^}]*)\}$', text, re.MULTILINE)
    check_grammar_enumerations(check, name, {enum: re.findall(r'\d+: (\w+)', body) for enum, body in enums})
    containers, leaves = (re.search(r'%s:\n        value: >-\n((?:          .*\n)+)' % part, text) for part in ('is_known_container', 'is_known_leaf'))
    cases = re.findall(r"^            '\"([A-Z]{4})\"': (\w+)$", text, re.MULTILINE)
    check.understood(containers and leaves and cases, 'bendy.ksy')
    check_grammar_ids(check, name, re.findall(r'"(\w{4})"', containers[1]), re.findall(r'"(\w{4})"', leaves[1]), chunks)
    check_grammar_ids(check, name, re.findall(r'"(\w{4})"', containers[1]), [chunk for chunk, _ in cases], chunks)


def check_hexpat(check, chunks, records):
    name = 'spec/bendy.hexpat'
    text = check.page('bendy.hexpat')
    enums, kinds = {}, {'float': 'f32', 'char': 'u8'}
    for enum, kind, body in re.findall(r'^enum (\w+) : (u8|u16) \{ ([^}]*) \};$', text, re.MULTILINE):
        values = re.findall(r'(\w+) = (\d+)', body)
        check.same(name, 'values of ' + enum, [value for _, value in values], [str(k) for k in range(len(values))])
        enums[snake(enum)] = [word.rstrip('_') for word, _ in values]
        kinds[enum] = kind
    check_grammar_enumerations(check, name, enums)
    found = {}
    for struct, body in re.findall(r'^struct (\w+Record) \{\n([^}]*)\};$', text, re.MULTILINE):
        fields = re.findall(r'^    (\w+) (\w+)(?:\[(\d+)\])?;$', body, re.MULTILINE)
        found[struct] = [(field, kinds.get(kind, kind), int(count or 1)) for kind, field, count in fields]
    check_grammar_records(check, name, found, records)
    containers = re.search(r'if \((header.id == "HEAD"[^)]*)\)', text)
    leaves = re.findall(r'^    else if \(header.id == "(\w{4})"', text, re.MULTILINE)
    check.understood(containers and leaves, 'bendy.hexpat')
    check_grammar_ids(check, name, re.findall(r'"(\w{4})"', containers[1]), sorted(set(leaves)), chunks)


def anchors(page):
    outside = re.sub(r'```.*?```', '', page, flags=re.DOTALL)
    for heading in re.findall(r'^#+ (.*)$', outside, re.MULTILINE):
        yield re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-')


def check_links(check):
    for path in sorted(check.spec.glob('**/*.md')):
        page = path.read_text(encoding='utf-8')
        name = path.relative_to(check.source).as_posix()
        for target, anchor in re.findall(r'\]\(([^)#\s]*)(?:#([^)\s]*))?\)', re.sub(r'```.*?```', '', page, flags=re.DOTALL)):
            check.comparisons += 1
            other = path.parent / target if target else path
            if not other.exists():
                check.fail(name, 'the link %s leads nowhere' % target)
            elif anchor and anchor not in anchors(other.read_text(encoding='utf-8')):
                check.fail(name, 'the link %s#%s leads to no heading' % (target, anchor))


def check_made_files(check):
    for script in ('make_bytes.py', 'make_grammar.py', 'make_text_schema.py', 'make_gltf_schema.py'):
        made = subprocess.run([sys.executable, '-B', str(check.spec / script), '--check'], capture_output=True, text=True)
        if made.returncode != 0:
            for line in (made.stdout + made.stderr).splitlines():
                check.fail('spec/' + script, line)
        check.comparisons += 1


def main(arguments):
    source = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent.parent).resolve()
    check = Check(source)
    chunks = read_chunks(check)
    records = read_records(check)
    check_chunk_pages(check, chunks)
    check_index(check, chunks)
    check_tree(check, chunks)
    check_records(check, records)
    check_quick(check, chunks, records)
    check_enumerations(check)
    check_leaves(check, chunks, records)
    check_streams(check)
    check_codes(check)
    check_constraints_of(check)
    check_references(check)
    check_gltf_extensions(check)
    check_flags(check)
    check_kaitai(check, chunks, records)
    check_hexpat(check, chunks, records)
    check_links(check)
    check_made_files(check)
    print('%d comparisons, %d differences' % (check.comparisons, check.differences))
    return 1 if check.differences else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
