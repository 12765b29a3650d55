#include <bendy/format/validate.h>

#include <bendy/format/check_sums.h>
#include <bendy/format/decode_leaves.h>
#include <bendy/format/document.h>

namespace bendy {

Faults validate(Bytes bytes) {
    Faults faults;
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) {
        faults.add(tree.error());
        return faults;
    }
    check_sums(*tree, faults);
    decode_leaves(*tree);
    const Document document = read_document(*tree, faults);
    check_values(*tree, document, faults);
    return faults;
}

}  // namespace bendy
