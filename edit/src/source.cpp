#include "source.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>

#include <string>
#include <utility>

namespace bendy::edit {
namespace {

Problem problem_of(const Error& fault, Bytes file) {
    return {describe_with_place(fault, file)};
}

}  // namespace

Result<Source, Problem> open_source(Bytes file) {
    auto tree = read_chunk_tree(file);
    if (!tree) return problem_of(tree.error(), file);
    Source source;
    source.tree = *std::move(tree);
    Faults faults;
    check_sums(source.tree, faults);
    decode_leaves(source.tree);
    source.document = read_document(source.tree, faults);
    if (faults.empty()) check_values(source.tree, source.document, faults);
    if (faults.empty()) return source;
    Problem problem = problem_of(faults.list().front(), file);
    if (faults.count() > 1) problem.message += ", and " + std::to_string(faults.count() - 1) + " more faults";
    return problem;
}

}  // namespace bendy::edit
