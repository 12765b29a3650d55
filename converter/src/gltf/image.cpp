#include "image.h"

#include "failure.h"
#include "source/media_type.h"
#include "source/read_file.h"
#include "source/uri.h"

#include <array>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace bendy::converter::gltf {
namespace {

class ImageImporter {
public:
    ImageImporter(const Document& document, bool embed) : document_(document), embed_(embed) {}

    Image import(std::size_t index) const {
        const Json& source = document_.json["images"][index];
        const std::string place = at("images", index);
        Image image;
        if (const Json* name = find(source, "name"); name != nullptr) image.name = name->get<std::string>();
        if (const Json* type = find(source, "mimeType"); type != nullptr) image.media_type = type->get<std::string>();
        const Json* view = find(source, "bufferView");
        const Json* uri = find(source, "uri");
        if (view != nullptr) {
            const auto bytes = document_.buffers.view(view->get<std::size_t>(), document_.budget);
            document_.budget.take(bytes.size(), 1, place);
            image.bytes.assign(bytes.begin(), bytes.end());
        } else if (uri != nullptr) {
            read_uri(uri->get_ref<const std::string&>(), place + ".uri", image);
        } else {
            document_.report.warn("image with neither bufferView nor uri", place);
        }
        if (const std::string seen = media_type_of(image.bytes); !seen.empty()) image.media_type = seen;
        return image;
    }

private:
    void read_uri(const std::string& uri, const std::string& place, Image& image) const {
        try {
            if (is_data_uri(uri)) {
                DataUri data = decode_data_uri(uri, place);
                if (image.media_type.empty()) image.media_type = std::move(data.media_type);
                image.bytes = std::move(data.bytes);
                return;
            }
            image.uri = uri;
            if (!embed_) return;
            const auto file = resolve_uri(uri, document_.file, place);
            document_.report.add_source(file);
            image.bytes = read_file(file, place);
            image.uri.clear();
        } catch (const Failure& failure) {
            // An image is not the motion: the character converts without it.
            document_.report.warn("image could not be read (" + failure.error.message + ')', place);
        }
    }

    const Document& document_;
    bool embed_;
};

}  // namespace

void import_images(const Document& document, bool embed, Scene& scene) {
    const ImageImporter importer(document, embed);
    for (std::size_t i = 0; i < array_of(document.json, "images").size(); ++i)
        scene.images.push_back(importer.import(i));
}

}  // namespace bendy::converter::gltf
