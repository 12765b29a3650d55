"""bendy_model and bendy_models: characters converted by `bendy convert`, with every input declared, so that actions can
run on other machines and their results come from a shared cache.

    load("//third_party/bendy:defs.bzl", "bendy_models")

    bendy_models(
        name = "characters",
        srcs = glob(["*.glb"]),
        options = ["--compact"],
        program = "//third_party/bendy:bendy",   # the program as one file: scripts/static.sh builds it
    )
"""

# Options that a build decides, and the attributes for them.
_RESERVED = {
    "-o": "out",
    "--output": "out",
    "--rig": "rig",
    "--depfile": "data",
    "--root": "data",
    "--force": None,
}

def _bendy_model_impl(ctx):
    for option in ctx.attr.options:
        word = option.split("=")[0]
        if word in _RESERVED:
            hint = "; use the attribute " + _RESERVED[word] if _RESERVED[word] else ""
            fail("options: %s is not for a build%s" % (word, hint), "options")
    output = ctx.actions.declare_file(ctx.attr.out or ctx.label.name + ".bendy")
    arguments = ctx.actions.args()
    arguments.add("convert")
    arguments.add(ctx.file.src)
    arguments.add("-o", output)
    arguments.add("--quiet")
    inputs = [ctx.file.src] + ctx.files.data
    if ctx.files.data:
        # The files that the source names may be in any package, and in a sandbox they are links: names in the execution root count.
        arguments.add("--root", ".")
    if ctx.file.rig:
        arguments.add("--rig", ctx.file.rig)
        inputs.append(ctx.file.rig)
    arguments.add_all(ctx.attr.options)
    ctx.actions.run(
        executable = ctx.executable.program,
        arguments = [arguments],
        inputs = inputs,
        outputs = [output],
        mnemonic = "BendyConvert",
        progress_message = "Converting %s" % ctx.file.src.short_path,
    )
    return [DefaultInfo(files = depset([output]), runfiles = ctx.runfiles(files = [output]))]

bendy_model = rule(
    implementation = _bendy_model_impl,
    doc = "Converts one character. The result depends on the declared files, the options and the program, and on nothing else.",
    attrs = {
        "src": attr.label(
            mandatory = True,
            allow_single_file = [".glb", ".gltf", ".vrm", ".vrma", ".x", ".md2", ".bvh", ".bendy"],
            doc = "The source.",
        ),
        "data": attr.label_list(
            allow_files = True,
            doc = "Files that the source refers to: buffers and images, of any package. The conversion fails if a buffer is missing.",
        ),
        "rig": attr.label(
            allow_single_file = [".json"],
            doc = "A rig file: constraints, IK chains, markers and curves.",
        ),
        "options": attr.string_list(doc = "Options of `bendy convert`: --compact, --lod, --max-error=0.1mm, ..."),
        "out": attr.string(doc = "The file's name; without one, the target's name with .bendy."),
        "program": attr.label(
            mandatory = True,
            executable = True,
            allow_single_file = True,
            cfg = "exec",
            doc = "The program bendy. With remote execution it must run there: the static build does.",
        ),
    },
)

def bendy_models(name, srcs, **attributes):
    """A bendy_model for each source: fox.glb becomes NAME/fox.bendy, and NAME is all of them.

    Args:
      name: of the group.
      srcs: the sources; no two may differ only in their suffix or in the case of letters.
      **attributes: those of bendy_model, for each of them.
    """
    targets, stems = [], {}
    for src in srcs:
        stem = src.split(":")[-1].rpartition(".")[0]
        target = "%s/%s" % (name, stem)
        if stem.lower() in stems:  # some systems ignore the case of names
            fail("bendy_models(%s): both %s and %s would become %s.bendy" % (name, stems[stem.lower()], src, target), "srcs")
        stems[stem.lower()] = src
        targets.append(target)
        bendy_model(name = target, src = src, **attributes)
    native.filegroup(name = name, srcs = targets, visibility = attributes.get("visibility"))
