#include "reports/suffixes.h"

#include <algorithm>
#include <array>

namespace bendy::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMeanings{
    Meaning{".bendy", "a bendy file", "convert"},
    Meaning{".glb", "binary glTF", "export"},
    Meaning{".gltf", "glTF", "export"},
    Meaning{".x", "an X-file", "export"},
    Meaning{".obj", "Wavefront OBJ", "pose"},
    Meaning{".ply", "PLY", "pose"},
    Meaning{".json", "JSON", "dump"},
    Meaning{".html", "HTML", "inspect"},
    Meaning{".htm", "HTML", "inspect"},
    Meaning{".png", "PNG", "render"},
    Meaning{".gif", "GIF", "render"},
    Meaning{".webp", "WebP", "render"},
    // Formats that bendy does not write: for models it suggests glTF instead, for pictures PNG.
    Meaning{".vrm", "VRM", {}},
    Meaning{".vrma", "a VRM animation", {}},
    Meaning{".md2", "a Quake II model", {}},
    Meaning{".md3", "a Quake III model", {}},
    Meaning{".md5mesh", "a Doom 3 model", {}},
    Meaning{".iqm", "IQM", {}},
    Meaning{".fbx", "FBX", {}},
    Meaning{".dae", "COLLADA", {}},
    Meaning{".blend", "a Blender file", {}},
    Meaning{".usd", "USD", {}},
    Meaning{".usda", "USD", {}},
    Meaning{".usdc", "USD", {}},
    Meaning{".usdz", "USD", {}},
    Meaning{".abc", "Alembic", {}},
    Meaning{".bvh", "BVH", {}},
    Meaning{".3ds", "3DS", {}},
    Meaning{".stl", "STL", {}},
    Meaning{".max", "a 3ds Max file", {}},
    Meaning{".ma", "a Maya file", {}},
    Meaning{".mb", "a Maya file", {}},
    Meaning{".jpg", "JPEG", {}},
    Meaning{".jpeg", "JPEG", {}},
    Meaning{".bmp", "BMP", {}},
    Meaning{".tga", "TGA", {}},
    Meaning{".tif", "TIFF", {}},
    Meaning{".tiff", "TIFF", {}},
    Meaning{".avif", "AVIF", {}},
    Meaning{".apng", "animated PNG", {}},
    Meaning{".mp4", "MP4", {}},
    Meaning{".webm", "WebM", {}},
    Meaning{".mov", "QuickTime", {}},
    Meaning{".avi", "AVI", {}},
    Meaning{".zip", "a ZIP archive", {}},
};

}  // namespace

const Meaning* find_meaning(std::string_view suffix) {
    const auto* const found = std::find_if(kMeanings.begin(), kMeanings.end(),
                                           [&](const Meaning& meaning) { return meaning.suffix == suffix; });
    return found == kMeanings.end() ? nullptr : found;
}

std::string suffix_of(const fs::path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return suffix;
}

std::string_view format_named_by(const fs::path& file) {
    const Meaning* meaning = find_meaning(suffix_of(file));
    return meaning == nullptr ? std::string_view() : meaning->format;
}

}  // namespace bendy::tools
