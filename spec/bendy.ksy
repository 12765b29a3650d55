# The grammar of Bendy files, version 0.1, for Kaitai Struct (https://kaitai.io). Compile it to a reader in one of a dozen
# languages, or use it to inspect a file in the Kaitai Web IDE. It describes the grammar only: the pages beside this file
# hold stands on the pages beside this file, and sums are not checked here. make_grammar.py writes bendy.ksy from
# bendy.ksy.in and the tables of format/; tests/spec/check_spec.py compares it with the tables of those pages.
meta:
  id: bendy
  title: Bendy animated character
  file-extension: bendy
  license: MIT
  ks-version: '0.10'
  endian: le
  bit-endian: le
  encoding: UTF-8
doc: |
  A file is one chunk, HEAD, and nothing else; a chunk is a header of 16 bytes and a payload, which in a container is
  chunks. See grammar.md and tree.md.
doc-ref: README.md
seq:
  - {id: head, type: chunk(true), doc: "the file"}
types:
  header:
    doc: "grammar.md, Header."
    seq:
      - {id: id, type: str, size: 4, encoding: ASCII, doc: "four characters, each A to Z or 0 to 9, in reading order"}
      - {id: sum, type: u4, doc: "CRC-32C of id, size and flags, then payload or the children's sums"}
      - {id: size_low, type: u4, doc: "bits 0 to 31 of the size"}
      - {id: size_high, type: u2, doc: "bits 32 to 47 of the size"}
      - {id: flags, type: u2, doc: "1 container, 2 required, 0xfc zero, 0xff00 codec"}
    instances:
      size: {value: size_low + size_high * 4294967296, doc: "bytes of the payload"}
      is_container: {value: flags & 1 != 0}
      is_required: {value: flags & 2 != 0}
      reserved_flags: {value: flags & 0xfc}
      codec: {value: flags >> 8}
  chunk:
    doc: "A header, a payload, and zeros up to the next multiple of 16."
    params:
      - {id: is_named, type: bool, doc: "whether ids have a meaning here: all containers above are known"}
    seq:
      - {id: header, type: header}
      - {id: chunks, type: chunks(is_known_container), size: header.size, if: header.is_container}
      - {id: payload, size: header.size, if: not header.is_container, type: payload(kind)}
      - {id: padding, size: (16 - header.size % 16) % 16, doc: "zeros"}
    instances:
      is_known_container:
        value: >-
          is_named and (header.id == "HEAD" or header.id == "TEXT" or header.id == "MATE" or header.id == "OBJE" or
          header.id == "SKIN" or header.id == "PIVO" or header.id == "IKCH" or header.id == "VECT" or
          header.id == "TARG" or header.id == "FRMS" or header.id == "USER" or header.id == "CYCL")
      is_known_leaf:
        value: >-
          header.id == "VERS" or header.id == "BNDS" or header.id == "SAMP" or header.id == "IMAG" or
          header.id == "LINK" or header.id == "SAME" or header.id == "SURF" or header.id == "EXTN" or
          header.id == "NAME" or header.id == "EXTR" or header.id == "MORE" or header.id == "REST" or
          header.id == "LIMT" or header.id == "PULL" or header.id == "POLY" or header.id == "JNTS" or
          header.id == "JNAM" or header.id == "ROLE" or header.id == "STND" or header.id == "KINF" or
          header.id == "VINF" or header.id == "PALT" or header.id == "TINF" or header.id == "FNAM" or
          header.id == "GRID" or header.id == "NLST" or header.id == "POSI" or header.id == "NORM" or
          header.id == "TANG" or header.id == "TEXC" or header.id == "COLR" or header.id == "BONE" or
          header.id == "WGHT" or header.id == "VALS" or header.id == "INDX" or header.id == "LODD" or
          header.id == "CINF" or header.id == "TRAK" or header.id == "PACK" or header.id == "PLAY" or
          header.id == "TIME" or header.id == "KEYV" or header.id == "MARK" or header.id == "CURV"
      kind:
        value: 'not is_named ? "" : header.codec == 0 ? header.id : is_known_leaf ? "coded" : ""'
        doc: "what the payload is read as"
  chunks:
    params:
      - {id: is_named, type: bool}
    seq:
      - {id: list, type: chunk(is_named), repeat: eos}
  payload:
    doc: "A leaf's payload. An encoded payload must be decoded first: pass the decoded bytes to payload(its id)."
    params:
      - {id: kind, type: str, doc: "the chunk's id; coded for an encoded leaf, empty where ids have no meaning"}
    seq:
      - id: body
        size-eos: true
        type:
          switch-on: kind
          cases:
            '"coded"': encoded
            '"VERS"': version_record
            '"BNDS"': bound_record
            '"SAMP"': sampler_record
            '"IMAG"': image
            '"LINK"': text
            '"SAME"': same_record
            '"SURF"': surface_record
            '"EXTN"': text
            '"NAME"': text
            '"EXTR"': text
            '"MORE"': text
            '"REST"': rest_record
            '"LIMT"': constraint_record
            '"PULL"': chain_weight_record
            '"POLY"': submesh_record
            '"JNTS"': joints
            '"JNAM"': jnam_list
            '"ROLE"': role_list
            '"STND"': standing_pose
            '"KINF"': chain_record
            '"VINF"': mesh_record
            '"PALT"': palette
            '"TINF"': morph_target_record
            '"FNAM"': fnam_list
            '"GRID"': grid_list
            '"NLST"': nlst_list
            '"POSI"': stream
            '"NORM"': stream
            '"TANG"': stream
            '"TEXC"': stream
            '"COLR"': stream
            '"BONE"': stream
            '"WGHT"': stream
            '"VALS"': stream
            '"INDX"': stream
            '"LODD"': collapse_sequence
            '"CINF"': clip_record
            '"TRAK"': trak_list
            '"PACK"': packed_tracks
            '"PLAY"': play_list
            '"TIME"': time_list
            '"KEYV"': time_list
            '"MARK"': marker_list
            '"CURV"': curve
  encoded:
    doc: "codecs.md."
    seq:
      - {id: size, type: u8, doc: "bytes of the decoded payload"}
      - {id: head, type: u2, doc: "bytes at its start that are no rows or triangles"}
      - {id: stride, type: u2, doc: "bytes of a row, a number or an index"}
      - {id: reserved, type: u4, doc: "zero"}
      - {id: body, size-eos: true}
  text:
    seq:
      - {id: value, type: str, size-eos: true}
  image:
    seq:
      - {id: record, type: image_record}
      - {id: image, size-eos: true, doc: "a PNG, JPEG, ... file"}
  joints:
    seq:
      - {id: record, type: joints_record}
      - {id: rests, type: rest_record, size: 52, repeat: expr, repeat-expr: record.joints, doc: "rest transform of each joint, all 52 bytes"}
      - {id: ranges, type: joint_submesh, repeat: expr, repeat-expr: record.submeshes, doc: "a joint, and a submesh that belongs to it"}
  role_list:
    seq:
      - {id: roles, type: role_record, size: 8, repeat: eos, doc: "what joints are"}
  standing_pose:
    seq:
      - {id: record, type: standing_pose_record}
      - {id: rotations, type: standing_rotation_record, size: 16, repeat: eos, doc: "how joints are turned"}
  jnam_list:
    seq:
      - {id: names, type: strz, repeat: eos, doc: "a name for each joint"}
  fnam_list:
    seq:
      - {id: names, type: strz, repeat: eos, doc: "a name for each frame"}
  palette:
    seq:
      - {id: record, type: palette_record}
      - {id: joints, type: u4, repeat: expr, repeat-expr: record.entries, doc: "joint of each entry"}
      - {id: joints_zeros, size: (16 - _io.pos % 16) % 16}
      - {id: matrices, type: f4, repeat: expr, repeat-expr: 'record.derived != 1 ? 16 * record.entries : 16', doc: "inverse bind matrices, column by column"}
  stream:
    seq:
      - {id: record, type: stream_record}
      - {id: box, type: f4, repeat: expr, repeat-expr: 2 * record.components, if: record.normalised == numbers::boxed, doc: "minimum and step of each component"}
      - {id: box_zeros, size: (16 - _io.pos % 16) % 16, if: record.normalised == numbers::boxed}
      - id: values
        repeat: expr
        repeat-expr: record.elements * record.components
        doc: "elements x components numbers"
        type:
          switch-on: record.component_type
          cases:
            component_type::u8: u1
            component_type::i8: s1
            component_type::u16: u2
            component_type::i16: s2
            component_type::u32: u4
            component_type::f32: f4
  grid_list:
    seq:
      - {id: values, type: f4, repeat: eos, doc: "minimum and step of each axis"}
  nlst_list:
    seq:
      - {id: values, type: f4, repeat: eos, doc: "unit vectors"}
  trak_list:
    seq:
      - {id: tracks, type: track_record, size: 24, repeat: eos, doc: "tracks"}
  play_list:
    seq:
      - {id: plays, type: play_record, size: 16, repeat: eos, doc: "frames that are played"}
  time_list:
    seq:
      - {id: values, type: f4, repeat: eos, doc: "numbers that the tracks share"}
  curve:
    seq:
      - {id: record, type: curve_record}
      - {id: box, type: f4, repeat: expr, repeat-expr: 2 * record.components, if: record.packed == 1, doc: "smallest value of each component, then the largest of each"}
      - {id: times, type: f4, repeat: expr, repeat-expr: record.keys, doc: "seconds of each key"}
      - id: key_values
        repeat: expr
        repeat-expr: record.values
        doc: "values of each key; if cubic in-tangent, value, out-tangent"
        type:
          switch-on: record.packed == 1
          cases:
            true: u2
            false: f4
      - {id: path, type: str, size: record.path_size, doc: "of the property, from the target"}
      - {id: name, type: str, size: record.name_size, doc: "the author's"}
  joint_submesh:
    seq:
      - {id: joint, type: u4, doc: "to which the polygons belong"}
      - {id: mesh, type: u4, doc: "VECT number in the object"}
      - {id: material, type: u4, doc: "MATE number in HEAD; with the top bit set, number among the joint's own MATE; 0xFFFFFFFF: none"}
      - {id: first, type: u4, doc: "first entry in the mesh's INDX"}
      - {id: count, type: u4, doc: "number of entries: a multiple of 3, 2 or 1, depending on topology"}
      - {id: topology, type: u1, enum: topology, doc: "0 triangles, 1 lines, 2 points"}
      - {id: reserved, size: 3, doc: "zero"}
  collapse_sequence:
    seq:
      - {id: record, type: collapse_record}
      - {id: meshes, type: mesh_collapse_record, repeat: expr, repeat-expr: record.meshes}
      - {id: levels, type: collapse_level(record.meshes), repeat: expr, repeat-expr: record.levels}
      - {id: zeros, size: (16 - record.levels * (record.meshes + 1) * 4 % 16) % 16}
      - {id: rest, size-eos: true, doc: "for each mesh: targets, zeros, joined bits, zeros; their number depends on the vertices in its VINF: see collapses"}
  collapse_level:
    params:
      - {id: meshes, type: u4}
    seq:
      - {id: error, type: f4, doc: "metres"}
      - {id: alive, type: u4, repeat: expr, repeat-expr: meshes, doc: "vertices of each mesh"}
  collapses:
    doc: "The data after the levels, for each mesh; count is its number of vertices minus its base, which is in another chunk."
    params:
      - {id: count, type: u4}
      - {id: target_type, type: u1, enum: component_type}
    seq:
      - id: targets
        repeat: expr
        repeat-expr: count
        type:
          switch-on: target_type
          cases:
            component_type::u16: u2
            component_type::u32: u4
      - {id: targets_zeros, size: '(16 - count * (target_type == component_type::u16 ? 2 : 4) % 16) % 16'}
      - {id: joined, type: b1, repeat: expr, repeat-expr: count}
      - {id: joined_zeros, size: (16 - (count + 7) / 8 % 16) % 16}
  marker_list:
    seq:
      - {id: record, type: markers_record}
      - {id: markers, type: marker_record, repeat: expr, repeat-expr: record.markers}
      - {id: names, type: 'marker_name(markers[_index].name_end - (_index == 0 ? 0 : markers[_index - 1].name_end))', repeat: expr, repeat-expr: record.markers}
  marker_name:
    params:
      - {id: size, type: u4}
    seq:
      - {id: value, type: str, size: size}
  packed_tracks:
    doc: "chunks/PACK.md."
    seq:
      - {id: record, type: pack_record}
      - {id: masks, type: 'mask(record.lists >> _index & 1 != 0 ? record.joints : 0)', repeat: expr, repeat-expr: 8, doc: "the joints for which a list has tracks"}
      - {id: steps, type: 'step_list(masks[_index].tracks * (_index / 2 == 2 ? 1 : 3))', repeat: expr, repeat-expr: 8}
      - {id: constant_bases, type: 'base_list(masks[_index * 2].tracks * (_index == 2 ? 1 : 3), record.wide >> _index * 2 & 1 != 0)', repeat: expr, repeat-expr: 4, doc: "of lists 0, 2, 4, 6"}
      - {id: times, type: f4, repeat: expr, repeat-expr: record.frames, if: record.frame_rate == 0}
      - {id: starts, type: u4, repeat: expr, repeat-expr: segment_count, if: segment_count > 1, doc: "where segments start, from the start of the payload"}
      - {id: segments, type: segment(_index), repeat: expr, repeat-expr: segment_count}
      - {id: tail, size: 4, doc: "zeros"}
    instances:
      is_animated: {value: 'masks[1].tracks + masks[3].tracks + masks[5].tracks + masks[7].tracks > 0'}
      segment_count: {value: 'not is_animated ? 0 : record.segment_frames == 0 ? 1 : (record.frames - 2) / record.segment_frames + 1'}
  mask:
    params:
      - {id: joints, type: u2}
    seq:
      - {id: bytes, type: 'mask_byte(_index == 0 ? 0 : bytes[_index - 1].total)', repeat: expr, repeat-expr: (joints + 7) / 8}
    instances:
      tracks: {value: 'joints == 0 ? 0 : bytes.last.total', doc: "bits set"}
  mask_byte:
    params:
      - {id: before, type: u4}
    seq:
      - {id: bits, type: u1}
    instances:
      total: {value: before + (bits & 1) + (bits >> 1 & 1) + (bits >> 2 & 1) + (bits >> 3 & 1) + (bits >> 4 & 1) + (bits >> 5 & 1) + (bits >> 6 & 1) + (bits >> 7)}
  step_list:
    params:
      - {id: count, type: u4}
    seq:
      - {id: bytes, type: u1, repeat: expr, repeat-expr: count, doc: "s stands for a step of 2^((s - 160) / 4)"}
  base_list:
    params:
      - {id: count, type: u4}
      - {id: is_wide, type: bool}
    seq:
      - id: bases
        repeat: expr
        repeat-expr: count
        type:
          switch-on: is_wide
          cases:
            true: s4
            false: s2
  segment:
    params:
      - {id: number, type: u4}
    seq:
      - {id: lists, type: segment_list(_index * 2 + 1), repeat: expr, repeat-expr: 4, doc: "of lists 1, 3, 5, 7"}
      - {id: frames, size: '(bits + 7) / 8', repeat: expr, repeat-expr: last - first + 1, doc: "numbers, each with the number of bits that its width gives"}
    instances:
      first: {value: number * _parent.record.segment_frames, doc: "frame"}
      last: {value: 'number + 1 == _parent.segment_count ? _parent.record.frames - 1 : first + _parent.record.segment_frames', doc: "frame"}
      bits: {value: 'lists[0].bits + lists[1].bits + lists[2].bits + lists[3].bits', doc: "of a frame"}
  segment_list:
    params:
      - {id: list, type: u1}
    seq:
      - {id: widths, type: 'width(_index == 0 ? 0 : widths[_index - 1].total)', repeat: expr, repeat-expr: count}
      - {id: bases, type: 'base_list(count, _parent._parent.record.wide >> list & 1 != 0)'}
    instances:
      count: {value: '_parent._parent.masks[list].tracks * (list == 5 ? 1 : 3)', doc: "numbers of a frame"}
      bits: {value: 'count == 0 ? 0 : widths.last.total'}
  width:
    params:
      - {id: before, type: u4}
    seq:
      - {id: bits, type: u1}
    instances:
      total: {value: before + bits}

  # The records: one line for each field, as records.def and the tables of the pages have them.
  version_record:
    seq:
      - {id: signature, size: 8, doc: "42 45 4E 44 59 0D 0A 1A: BENDY, CR, LF, Ctrl-Z"}
      - {id: major, type: u2, doc: "major version; a reader refuses any that it does not know"}
      - {id: minor, type: u2, doc: "minor version; later ones only add what readers may skip"}
      - {id: objects, type: u4, doc: "number of OBJE chunks"}
      - {id: joints, type: u4, doc: "number of SKIN chunks in all objects"}
      - {id: meshes, type: u4, doc: "number of VECT chunks in all objects"}
      - {id: vertices, type: u8, doc: "total number of vertices of all meshes"}
      - {id: clips, type: u4, doc: "number of CYCL chunks in all objects"}
      - {id: materials, type: u4, doc: "number of MATE chunks, including local ones"}
      - {id: textures, type: u4, doc: "number of TEXT chunks"}
      - {id: reserved, type: u4, doc: "zero"}
      - {id: generator, size: 32, type: str, if: not _io.eof, doc: "name and version of the program that wrote the file, UTF-8, padded with zeros"}
  bound_record:
    seq:
      - {id: max_error, type: f4, doc: "metres: no point of the skin is farther than this from its position in the source"}
      - {id: measured_error, type: f4, doc: "metres: the largest distance that the writer measured"}
      - {id: height, type: f4, doc: "metres: the character's height in the rest pose"}
  sampler_record:
    seq:
      - {id: mag_filter, type: u1, enum: filter, doc: "0 unspecified, 1 nearest, 2 linear"}
      - {id: min_filter, type: u1, enum: filter, doc: "0 to 2 as for mag_filter; with the nearest mipmap: 3 nearest, 4 linear; linear between mipmaps: 5 nearest, 6 linear"}
      - {id: wrap_s, type: u1, enum: wrap, doc: "0 repeat, 1 clamp to edge, 2 mirrored repeat"}
      - {id: wrap_t, type: u1, enum: wrap, doc: "as for wrap_s"}
  same_record:
    seq:
      - {id: texture, type: u4, doc: "TEXT number in HEAD"}
      - {id: image, type: u4, doc: "image number in that TEXT; must be an IMAG or a LINK"}
  texture_use_record:
    seq:
      - {id: texture, type: u4, doc: "TEXT number; 0xFFFFFFFF: none"}
      - {id: coords, type: u4, doc: "set number of the texture coordinates"}
      - {id: offset, type: f4, repeat: expr, repeat-expr: 2, doc: "added to the coordinates after scale and rotation"}
      - {id: scale, type: f4, repeat: expr, repeat-expr: 2, doc: "scale factors of the coordinates"}
      - {id: rotation, type: f4, doc: "radians, counter-clockwise about the origin"}
      - {id: reserved, type: u4, doc: "zero"}
  surface_record:
    seq:
      - {id: base_colour, type: f4, repeat: expr, repeat-expr: 4, doc: "red, green, blue, alpha; linear, 0 to 1"}
      - {id: emissive, type: f4, repeat: expr, repeat-expr: 3, doc: "red, green, blue; linear, 0 or more"}
      - {id: metallic, type: f4, doc: "0 to 1"}
      - {id: roughness, type: f4, doc: "0 to 1"}
      - {id: normal_scale, type: f4, doc: "scales x and y of the normal texture"}
      - {id: occlusion_strength, type: f4, doc: "0 to 1"}
      - {id: alpha_cutoff, type: f4, doc: "for alpha mode 1"}
      - {id: alpha_mode, type: u1, enum: alpha_mode, doc: "0 opaque, 1 mask, 2 blend"}
      - {id: double_sided, type: u1, doc: "0 or 1"}
      - {id: unlit, type: u1, doc: "0 or 1; 1: only the base colour is used, as in KHR_materials_unlit"}
      - {id: reserved, size: 13, doc: "zero"}
      - {id: base_colour_texture, type: texture_use_record, doc: "colour in sRGB, alpha linear"}
      - {id: metallic_roughness_texture, type: texture_use_record, doc: "green: roughness, blue: metallic; linear"}
      - {id: normal_texture, type: texture_use_record, doc: "tangent space, linear"}
      - {id: occlusion_texture, type: texture_use_record, doc: "red: occlusion; linear"}
      - {id: emissive_texture, type: texture_use_record, doc: "sRGB"}
  rest_record:
    seq:
      - {id: rotation, type: f4, repeat: expr, repeat-expr: 4, doc: "unit quaternion x y z w"}
      - {id: translation, type: f4, repeat: expr, repeat-expr: 3, doc: "metres, in the parent's space"}
      - {id: scale, type: f4, repeat: expr, repeat-expr: 3, doc: "factors along the joint's axes; may be negative or zero"}
      - {id: shear, type: f4, repeat: expr, repeat-expr: 3, if: not _io.eof, doc: "xy, xz, yz: the entries above the diagonal"}
  constraint_record:
    seq:
      - {id: model, type: u1, enum: constraint_model, doc: "0 free, 1 locked, 2 hinge, 3 swing-twist ellipse, 4 swing-twist pyramid, 5 Euler box, 6 largest angle"}
      - {id: euler_order, type: u1, enum: euler_order, doc: "for an Euler box, the axes in the order of their rotations: 0 XYZ, 1 XZY, 2 YXZ, 3 YZX, 4 ZXY, 5 ZYX; otherwise 0"}
      - {id: scope, type: u1, enum: constraint_scope, doc: "0 every pose, 1 only the IK solver, 2 every pose except the IK solver's"}
      - {id: flags, type: u1, doc: "sum of 1 approximated, 2 proposed, 4 rest pose outside"}
      - {id: soft_zone, type: f4, doc: "radians: width of the zone inside the limits in which an IK solver halves steps towards them; 0: none"}
      - {id: frame, type: f4, repeat: expr, repeat-expr: 4, doc: "C, unit quaternion x y z w in the joint's rest space: its X is the twist or hinge axis, its Y and Z the swing axes"}
      - {id: rotation_min, type: f4, repeat: expr, repeat-expr: 3, doc: "radians about X, Y, Z of the frame; -infinity: free"}
      - {id: rotation_max, type: f4, repeat: expr, repeat-expr: 3, doc: "radians about X, Y, Z of the frame; infinity: free"}
      - {id: translation_min, type: f4, repeat: expr, repeat-expr: 3, doc: "metres from the rest translation, along X, Y, Z of the frame; -infinity: free"}
      - {id: translation_max, type: f4, repeat: expr, repeat-expr: 3, doc: "metres from the rest translation, along X, Y, Z of the frame; infinity: free"}
      - {id: stiffness, type: f4, repeat: expr, repeat-expr: 3, doc: "0 to 1 about X, Y, Z of the frame: how much an IK solver resists turning about the axis; 1 locks it"}
      - {id: preferred, type: f4, repeat: expr, repeat-expr: 3, doc: "radians about X, Y, Z of the frame: where a solver restarts when it is stuck, and which way a straight chain bends"}
  role_record:
    seq:
      - {id: joint, type: u4, doc: "joint number; ascending"}
      - {id: role, type: u2, enum: role, doc: "what the joint is: a value of the list of roles, 1 or more"}
      - {id: place, type: u2, doc: "for a chain, the joint's place in it, ascending from the body outwards; otherwise 0"}
  standing_pose_record:
    seq:
      - {id: axes, type: f4, repeat: expr, repeat-expr: 4, doc: "unit quaternion x y z w: from the body's axes, X left, Y up, Z forward, to model space"}
      - {id: ground, type: f4, doc: "metres: the coordinate of the ground of the clips along the body's up"}
      - {id: height, type: f4, doc: "metres, 0 or more: from the lowest to the highest joint with a role in the standing pose"}
      - {id: evidence, type: u1, enum: standing_evidence, doc: "where the pose comes from: 0 a person or another program said so, 1 bind matrices, 2 a frame of a clip, 3 the rest pose, turned upright as a whole, 4 names and the lengths of bones alone"}
      - {id: reserved, size: 7, doc: "zero"}
  standing_rotation_record:
    seq:
      - {id: joint, type: u4, doc: "joint number; ascending"}
      - {id: rotation, type: f4, repeat: expr, repeat-expr: 3, doc: "x y z of the unit quaternion from the joint's axes to model space, whose w, sqrt(1 - x*x - y*y - z*z), is not negative; w is 0 where the sum of squares exceeds 1"}
  chain_weight_record:
    seq:
      - {id: chain, type: u4, doc: "IKCH number in the object"}
      - {id: weight, type: f4, doc: "0 to 1: how much the joint moves for the chain; a joint without PULL has weight 1"}
  chain_record:
    seq:
      - {id: start, type: u4, doc: "the first joint that turns: the effector or one of its ancestors"}
      - {id: effector, type: u4, doc: "the joint that carries the tip"}
      - {id: target, type: u4, doc: "the joint to reach; 0xFFFFFFFF: none"}
      - {id: pole, type: u4, doc: "the joint that the chain bends towards; 0xFFFFFFFF: none"}
      - {id: solver, type: u1, enum: solver, doc: "0 the reader's choice, 1 pull, 2 two-bone, 3 CCD, 4 FABRIK, 5 aim, 6 damped least squares"}
      - {id: flags, type: u1, doc: "sum of 1 approximated, 2 proposed"}
      - {id: iterations, type: u2, doc: "maximum number of iterations; 0: the solver's default"}
      - {id: priority, type: u1, doc: "chains with a higher priority are solved later and override the others"}
      - {id: reserved, size: 3, doc: "zero"}
      - {id: tolerance, type: f4, doc: "metres: the target counts as reached within this distance; 0: the solver's default"}
      - {id: pole_vector, type: f4, repeat: expr, repeat-expr: 3, doc: "if there is no pole joint, the direction to bend towards, in the space of start's parent; zeros: none"}
      - {id: pole_angle, type: f4, doc: "radians from the pole to the bend, about the line from start to target"}
      - {id: tip_offset, type: f4, repeat: expr, repeat-expr: 3, doc: "metres: position of the tip in the effector's space"}
      - {id: tip_rotation, type: f4, repeat: expr, repeat-expr: 4, doc: "unit quaternion x y z w: orientation of the tip in the effector's space"}
      - {id: position_weight, type: f4, doc: "0 to 1: weight of the target's position"}
      - {id: rotation_weight, type: f4, doc: "0 to 1: weight of the target's orientation"}
      - {id: influence, type: f4, doc: "0 to 1: how much of the solution is blended in when a player runs the file's chains; 0: initially off"}
      - {id: stretch, type: f4, doc: "0 or more: the fraction of its length by which the chain may grow to reach the target"}
      - {id: compress, type: f4, doc: "0 to 1: the fraction of its length by which the chain may shrink"}
  submesh_record:
    seq:
      - {id: mesh, type: u4, doc: "VECT number in the object"}
      - {id: material, type: u4, doc: "MATE number in HEAD; with the top bit set, number among the joint's own MATE; 0xFFFFFFFF: none"}
      - {id: first, type: u4, doc: "first entry in the mesh's INDX"}
      - {id: count, type: u4, doc: "number of entries: a multiple of 3, 2 or 1, depending on topology"}
      - {id: topology, type: u1, enum: topology, doc: "0 triangles, 1 lines, 2 points"}
      - {id: reserved, size: 3, doc: "zero"}
  joints_record:
    seq:
      - {id: joints, type: u4, doc: "number of SKIN chunks in the object; as many RestRecords of 52 bytes follow"}
      - {id: submeshes, type: u4, doc: "number of submeshes, which follow the rest transforms: u32 joint and a SubmeshRecord, 24 bytes each"}
      - {id: reserved, type: u4, repeat: expr, repeat-expr: 2, doc: "zero"}
  mesh_record:
    seq:
      - {id: vertices, type: u4, doc: "number of vertices; every stream has this many elements"}
      - {id: joint, type: u4, doc: "the joint that carries the mesh; 0xFFFFFFFF: none"}
  morph_target_record:
    seq:
      - {id: rest_weight, type: f4, doc: "weight when no clip animates it"}
  clip_record:
    seq:
      - {id: start, type: f4, doc: "seconds: time of the earliest key"}
      - {id: end, type: f4, doc: "seconds: time of the latest key; the length of the clip is end - start"}
      - {id: frame_rate, type: f4, doc: "frames per second of PLAY and of tracks with fixed frames; 0 if there are none"}
      - {id: loop, type: u1, doc: "0: play once, 1: repeat"}
      - {id: reserved, size: 3, doc: "zero"}
  marker_record:
    seq:
      - {id: seconds, type: f4, doc: "seconds on the time line of the clip, from start to end"}
      - {id: name_end, type: u4, doc: "offset in the names of the first byte after this marker's name; the name begins where the previous one ends"}
  markers_record:
    seq:
      - {id: markers, type: u4, doc: "number of MarkerRecords, which follow this record; the names follow them, UTF-8, without gaps"}
      - {id: reserved, type: u4, doc: "zero"}
  pack_record:
    seq:
      - {id: frames, type: u4, doc: "number of frames, 1 or more; 2 or more if a track is animated"}
      - {id: start, type: f4, doc: "seconds: the time of frame 0"}
      - {id: frame_rate, type: f4, doc: "frames per second; 0: a table holds the times of the frames"}
      - {id: joints, type: u2, doc: "number of joints that the bit masks of the lists cover"}
      - {id: segment_frames, type: u2, doc: "frames from the start of one segment to the start of the next; 0: one segment"}
      - {id: lists, type: u1, doc: "bit k: list k has tracks"}
      - {id: wide, type: u1, doc: "bit k: the bases of list k have 4 bytes instead of 2"}
      - {id: reserved, size: 2, doc: "zero"}
  curve_record:
    seq:
      - {id: keys, type: u4, doc: "number of keys, 1 or more"}
      - {id: components, type: u1, doc: "numbers per value: 1 to 4"}
      - {id: interpolation, type: u1, enum: interpolation, doc: "0 step, 1 linear, 2 cubic"}
      - {id: packed, type: u1, doc: "0: values are f32; 1: values are u16 between the box's minima and maxima, which a cubic curve may not have"}
      - {id: kind, type: u1, enum: curve_target, doc: "what target numbers: 0 nothing, 1 joint, 2 material, 3 mesh, 4 texture"}
      - {id: target, type: u4, doc: "joint or VECT number inside the object, MATE or TEXT number in HEAD; 0xFFFFFFFF for kind 0"}
      - {id: max_error, type: f4, doc: "largest difference between a stored value and the source's; 0 exact"}
      - {id: values, type: u4, doc: "numbers: keys * components, three times as many if cubic"}
      - {id: path_size, type: u4, doc: "bytes of the property path, UTF-8"}
      - {id: name_size, type: u4, doc: "bytes of the name, UTF-8; 0 none"}
      - {id: reserved, type: u4, doc: "zero"}
  track_record:
    seq:
      - {id: target, type: u4, doc: "joint number; for weights, mesh number"}
      - {id: path, type: u1, enum: track_path, doc: "0 translation, 1 rotation, 2 scale, 3 weights"}
      - {id: interpolation, type: u1, enum: interpolation, doc: "0 step, 1 linear, 2 cubic"}
      - {id: components, type: u2, doc: "numbers per value: 3, 4, 3, or the mesh's number of morph targets"}
      - {id: keys, type: u4, doc: "number of keys, 1 or more"}
      - {id: first_time, type: u4, doc: "index into TIME; 0xFFFFFFFF: fixed frames, key k is at start + k / frame_rate"}
      - {id: first_value, type: u8, doc: "index into KEYV, counted in numbers"}
  play_record:
    seq:
      - {id: mesh, type: u4, doc: "VECT number in the object"}
      - {id: first, type: u4, doc: "frame at the clip's start; 0: the mesh's own streams, k: frame k - 1 of its FRMS"}
      - {id: frames, type: u4, doc: "number of frames, 1 or more; frame k is at start + k / frame_rate"}
      - {id: closed, type: u1, doc: "1: the first frame follows the last one after another 1 / frame_rate; otherwise 0"}
      - {id: reserved, size: 3, doc: "zero"}
  stream_record:
    seq:
      - {id: component_type, type: u1, enum: component_type, doc: "0 u8, 1 i8, 2 u16, 3 i16, 4 u32, 5 f32"}
      - {id: normalised, type: u1, enum: numbers, doc: "what integers represent: 0 themselves; 1 a fraction, 0 to 1, or -1 to 1 if signed; 2 minimum + step * integer; 3 an entry of the mesh's NLST"}
      - {id: components, type: u2, doc: "numbers per element, 1 or more"}
      - {id: elements, type: u4, doc: "number of elements, which follow this record without gaps"}
      - {id: set, type: u4, doc: "set number of a TEXC or COLR; otherwise zero"}
      - {id: reserved, type: u4, doc: "zero"}
  palette_record:
    seq:
      - {id: entries, type: u4, doc: "number of entries; joints u32[entries], zeros up to a multiple of 16 bytes and inverse bind matrices f32[16][entries] follow"}
      - {id: derived, type: u4, doc: "1: a single matrix f32[16] is stored, from which all matrices are derived with the rest pose; otherwise 0"}
      - {id: reserved, type: u4, repeat: expr, repeat-expr: 2, doc: "zero"}
  mesh_collapse_record:
    seq:
      - {id: mesh, type: u4, doc: "VECT number in the object; ascending"}
      - {id: base, type: u4, doc: "number of vertices that never collapse: the first ones of the mesh"}
      - {id: target_type, type: u1, enum: component_type, doc: "type of the collapse targets: 2 u16, 4 u32"}
      - {id: reserved, size: 7, doc: "zero"}
  collapse_record:
    seq:
      - {id: meshes, type: u4, doc: "number of MeshCollapseRecords, which follow this record"}
      - {id: levels, type: u4, doc: "number of rows in the table of levels, which follows them"}
      - {id: reserved, type: u4, repeat: expr, repeat-expr: 2, doc: "zero"}
  image_record:
    seq:
      - {id: media, type: u1, enum: media_type, doc: "0 other, 1 PNG, 2 JPEG, 3 KTX2, 4 WebP, 5 AVIF"}
      - {id: reserved, size: 15, doc: "zero; the image data follows this record"}
enums:
  filter: {0: unspecified, 1: nearest, 2: linear, 3: nearest_mipmap_nearest, 4: linear_mipmap_nearest, 5: nearest_mipmap_linear, 6: linear_mipmap_linear}
  wrap: {0: repeat, 1: clamp_to_edge, 2: mirrored_repeat}
  alpha_mode: {0: opaque, 1: mask, 2: blend}
  constraint_model: {0: free, 1: locked, 2: hinge, 3: swing_twist_ellipse, 4: swing_twist_pyramid, 5: euler_box, 6: largest_angle}
  euler_order: {0: xyz, 1: xzy, 2: yxz, 3: yzx, 4: zxy, 5: zyx}
  constraint_scope: {0: every_pose, 1: ik_only, 2: all_but_ik}
  role: {0: none, 1: hips, 2: spine, 3: chest, 4: upper_chest, 5: neck, 6: head, 7: left_eye, 8: right_eye, 9: jaw, 10: left_upper_leg, 11: left_lower_leg, 12: left_foot, 13: left_toes, 14: right_upper_leg, 15: right_lower_leg, 16: right_foot, 17: right_toes, 18: left_shoulder, 19: left_upper_arm, 20: left_lower_arm, 21: left_hand, 22: right_shoulder, 23: right_upper_arm, 24: right_lower_arm, 25: right_hand, 26: left_thumb_metacarpal, 27: left_thumb_proximal, 28: left_thumb_distal, 29: left_index_proximal, 30: left_index_intermediate, 31: left_index_distal, 32: left_middle_proximal, 33: left_middle_intermediate, 34: left_middle_distal, 35: left_ring_proximal, 36: left_ring_intermediate, 37: left_ring_distal, 38: left_little_proximal, 39: left_little_intermediate, 40: left_little_distal, 41: right_thumb_metacarpal, 42: right_thumb_proximal, 43: right_thumb_distal, 44: right_index_proximal, 45: right_index_intermediate, 46: right_index_distal, 47: right_middle_proximal, 48: right_middle_intermediate, 49: right_middle_distal, 50: right_ring_proximal, 51: right_ring_intermediate, 52: right_ring_distal, 53: right_little_proximal, 54: right_little_intermediate, 55: right_little_distal, 56: spine_chain, 57: neck_chain, 58: tail, 59: left_front_leg, 60: right_front_leg, 61: left_hind_leg, 62: right_hind_leg, 63: left_wing, 64: right_wing}
  standing_evidence: {0: told, 1: bind_pose, 2: clip, 3: rest_pose, 4: assumed}
  solver: {0: any, 1: pull, 2: two_bone, 3: ccd, 4: fabrik, 5: aim, 6: least_squares}
  topology: {0: triangles, 1: lines, 2: points}
  curve_target: {0: nothing, 1: joint, 2: material, 3: mesh, 4: texture}
  track_path: {0: translation, 1: rotation, 2: scale, 3: weights}
  interpolation: {0: step, 1: linear, 2: cubic}
  component_type: {0: u8, 1: i8, 2: u16, 3: i16, 4: u32, 5: f32}
  numbers: {0: plain, 1: normalised, 2: boxed, 3: listed}
  media_type: {0: other, 1: png, 2: jpeg, 3: ktx2, 4: webp, 5: avif}
