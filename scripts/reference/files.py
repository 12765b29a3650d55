"""Which arguments are files, by their extensions, which the help does not tell. Positional arguments and --output that
are not listed here are files of any kind."""

READABLE = "READABLE"  # as its help lists them

FILES = {
    ("convert", "IN"): f"{READABLE} .bendy",
    ("convert", "--depfile"): ".d",
    ("convert", "--output"): ".bendy",
    ("convert", "--rig"): ".json",
    ("convert", "--texture"): ".png .jpg .jpeg .tga .bmp .webp",
    ("inspect", "FILE"): f".bendy {READABLE}",
    ("inspect", "--html"): ".html",
    ("validate", "FILE"): f".bendy {READABLE}",
    ("pose", "FILE"): f".bendy {READABLE}",
    ("pose", "--output"): ".obj .ply .json",
    ("render", "FILE"): f".bendy {READABLE}",
    ("render", "--output"): ".png .gif .webp",
    ("rig", "FILE"): ".bendy",
    ("rig", "--output"): ".json",
    ("diff", "A"): f".bendy {READABLE}",
    ("diff", "B"): f".bendy {READABLE}",
    ("dump", "FILE"): ".bendy",
    ("dump", "--output"): ".json",
    ("assemble", "FILE"): ".json",
    ("assemble", "--output"): ".bendy",
    ("edit", "FILE"): f".bendy {READABLE}",
    ("edit", "--output"): ".bendy",
    ("edit", "--rename-joints"): ".json",
    ("edit", "--merge"): f".bendy {READABLE}",
    ("export", "FILE"): ".bendy",
    ("export", "--output"): ".glb .gltf .x",
    ("view", "FILE"): f".bendy {READABLE}",
    ("bench", "FILE"): ".bendy",
}
