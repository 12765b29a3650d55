#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include "sample_file.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// Changing good files into bad ones, and saying what is wrong with them.
namespace bendy::test {

/// A chunk that can be changed; written again, its sizes, padding and sums are right.
struct Node {
    FourCC id;
    std::uint16_t flags = 0;
    Buffer payload;              ///< of a leaf
    std::vector<Node> children;  ///< of a container

    [[nodiscard]] bool is_container() const { return (flags & kContainerFlag) != 0; }
};

inline Node make_leaf(FourCC id, Bytes payload = {}, std::uint16_t flags = 0) {
    return {id, flags, {payload.begin(), payload.end()}, {}};
}
inline Node make_container(FourCC id, std::vector<Node> children = {}, std::uint16_t flags = 0) {
    return {id, static_cast<std::uint16_t>(flags | kContainerFlag), {}, std::move(children)};
}

inline Node to_node(const ChunkTree& tree, std::uint32_t number = 0) {
    Node node;
    node.id = tree[number].id;
    node.flags = tree[number].flags;
    if (!node.is_container()) {
        const Bytes payload = tree.payload(number);
        node.payload.assign(payload.begin(), payload.end());
    }
    for (const std::uint32_t child : tree.children(number)) node.children.push_back(to_node(tree, child));
    return node;
}

inline Node to_node(Bytes file) {
    const auto tree = read_chunk_tree(file);
    if (!tree) throw std::runtime_error(describe(tree.error()));
    return to_node(*tree);
}

inline void put(ChunkWriter& writer, const Node& node) {
    if (!node.is_container()) return writer.leaf(node.id, node.payload, node.flags);
    writer.begin(node.id, node.flags);
    for (const Node& child : node.children) put(writer, child);
    writer.end();
}

inline Buffer to_file(const Node& root) {
    ChunkWriter writer;
    put(writer, root);
    return std::move(writer).finish();
}

/// The sample file, to be changed.
inline Node sample() {
    return to_node(sample_file());
}

/// The direct child with this id, the `place`-th of them from 0.
inline Node& child(Node& parent, std::string_view id, std::size_t place = 0) {
    for (Node& node : parent.children) {
        if (id == node.id.letters().data() && place-- == 0) return node;
    }
    throw std::out_of_range("there is no " + std::string(id));
}

/// The chunk at a path as chunk_path writes it.
inline Node& at(Node& root, std::string_view path) {
    Node* node = &root;
    for (std::size_t slash = path.find('/'); slash != std::string_view::npos; slash = path.find('/')) {
        path.remove_prefix(slash + 1);
        const std::string_view step = path.substr(0, path.find('/'));
        node = &child(*node, step.substr(0, 4), step.size() > 4 ? std::stoul(std::string(step.substr(5))) : 0);
    }
    return *node;
}

/// Takes the first child with this id away.
inline void remove(Node& parent, std::string_view id) {
    parent.children.erase(parent.children.begin() + (&child(parent, id) - parent.children.data()));
}

/// Changes the record of type R that starts `offset` bytes into the leaf's payload.
template <class R, class Change>
void edit(Node& leaf, Change change, std::size_t offset = 0) {
    R record;
    if (leaf.payload.size() < offset + sizeof(R)) throw std::out_of_range("the payload is shorter than the record");
    std::memcpy(&record, leaf.payload.data() + offset, sizeof(R));
    change(record);
    std::memcpy(leaf.payload.data() + offset, &record, sizeof(R));
}

/// Overwrites a number in a stream or another array, `offset` bytes into the payload.
template <class T>
void set(Node& leaf, std::size_t offset, T value) {
    edit<T>(
        leaf, [value](T& number) { number = value; }, offset);
}

/// Overwrites raw bytes of a file.
template <class T>
void patch(Buffer& file, std::uint64_t offset, T value) {
    if (offset + sizeof(T) > file.size()) throw std::out_of_range("past the end of the file");
    std::memcpy(file.data() + offset, &value, sizeof(T));
}

/// Makes every sum of a well-formed file right again; false if it is not well-formed.
inline bool resum(Buffer& file) {
    const auto tree = read_chunk_tree(file);
    if (!tree) return false;
    const auto chunks = tree->chunks();
    for (std::size_t number = chunks.size(); number-- > 0;) {  // children stand after their parents
        const std::uint64_t offset = chunks[number].offset;
        patch(file, offset + 4, chunk_sum(Bytes(file).subspan(offset)));
    }
    return true;
}

/// The offset of the header of the chunk at a path.
inline std::uint64_t place_of(Bytes file, std::string_view path) {
    const auto tree = read_chunk_tree(file);
    if (!tree) throw std::runtime_error(describe(tree.error()));
    const std::uint32_t number = find_path(*tree, path);
    if (number == kNone) throw std::out_of_range("there is no " + std::string(path));
    return (*tree)[number].offset;
}

using Lines = std::vector<std::string>;

/// Each fault as "CODE PATH".
inline Lines lines_of(const Faults& faults, Bytes file) {
    Lines lines;
    for (const Error& fault : faults.list())
        lines.push_back(std::string(code_name(fault.code)) + " " + chunk_path(file, fault.offset));
    return lines;
}

/// Everything that validate says of a file.
inline Lines faults_in(Bytes file) {
    return lines_of(validate(file), file);
}
inline Lines faults_in(const Node& root) {
    return faults_in(to_file(root));
}

/// A file with the tree and document read from it. The document's views stay good as long as this lives.
struct Loaded {
    explicit Loaded(const Node& root) : Loaded(to_file(root)) {}
    explicit Loaded(Buffer bytes) : file(std::move(bytes)) {
        auto read = read_chunk_tree(file);
        if (!read) throw std::runtime_error(describe(read.error()));
        tree = std::move(*read);
        document = read_document(tree, faults);
    }
    Loaded(const Loaded&) = delete;
    Loaded& operator=(const Loaded&) = delete;

    [[nodiscard]] Lines lines() const { return lines_of(faults, file); }

    Buffer file;
    ChunkTree tree;
    Faults faults;
    Document document;
};

}  // namespace bendy::test
