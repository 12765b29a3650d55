#include "plain_reader.h"

#include <string_view>

namespace bendy::fuzz {
namespace {

class Reader {
public:
    explicit Reader(std::span<const std::byte> file) : file_(file) {}

    PlainFile read() {
        PlainFile result;
        const bool is_head = file_.size() >= 16 && letters(0) == "HEAD";
        result.is_well_formed = is_head && chunk(0, file_.size(), 0) == file_.size() && (chunks_[0].flags & 1u) != 0;
        result.chunks = std::move(chunks_);
        return result;
    }

private:
    static constexpr std::uint64_t kRefused = ~std::uint64_t{0};

    [[nodiscard]] std::string letters(std::uint64_t at) const {
        std::string text;
        for (int k = 0; k < 4; ++k) text += static_cast<char>(file_[at + static_cast<unsigned>(k)]);
        return text;
    }
    [[nodiscard]] std::uint64_t number(std::uint64_t at, unsigned bytes) const {
        std::uint64_t value = 0;
        for (unsigned k = bytes; k-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(file_[at + k]);
        return value;
    }
    /// CRC-32C, bit by bit.
    void add_to_sum(std::uint32_t& sum, std::uint64_t at, std::uint64_t bytes) const {
        for (std::uint64_t k = 0; k < bytes; ++k) {
            sum ^= std::to_integer<std::uint32_t>(file_[at + k]);
            for (int bit = 0; bit < 8; ++bit) sum = (sum & 1u) != 0 ? sum >> 1 ^ 0x82f63b78u : sum >> 1;
        }
    }

    /// Where the chunk at `at` ends, which must not be behind `end`.
    std::uint64_t chunk(std::uint64_t at, std::uint64_t end, std::size_t depth) {
        if (end - at < 16) return kRefused;
        PlainChunk here{letters(at), at, number(at + 8, 6), static_cast<unsigned>(number(at + 14, 2)), depth, false};
        constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
        if (here.id.find_first_not_of(kAllowed) != std::string::npos) return kRefused;
        const bool is_container = (here.flags & 1u) != 0;
        if ((here.flags & 0xfcu) != 0 || (is_container && here.flags >> 8 != 0)) return kRefused;
        const std::uint64_t padding = (16 - here.size % 16) % 16;
        if (here.size + padding > end - at - 16 || (is_container && padding != 0)) return kRefused;
        const std::size_t place = chunks_.size();
        chunks_.push_back(here);
        std::uint32_t sum = 0xffffffffu;
        add_to_sum(sum, at, 4);
        add_to_sum(sum, at + 8, 8);
        const std::uint64_t after = at + 16 + here.size;
        if (is_container) {
            for (std::uint64_t child = at + 16; child != after;) {
                const std::uint64_t next = chunk(child, after, depth + 1);
                if (next == kRefused) return kRefused;
                add_to_sum(sum, child + 4, 4);
                child = next;
            }
        } else {
            add_to_sum(sum, at + 16, here.size);
            for (std::uint64_t k = 0; k < padding; ++k) {
                if (file_[after + k] != std::byte{0}) return kRefused;
            }
        }
        chunks_[place].sum_holds = (sum ^ 0xffffffffu) == number(at + 4, 4);
        return after + padding;
    }

    std::span<const std::byte> file_;
    std::vector<PlainChunk> chunks_;
};

}  // namespace

PlainFile read_plainly(std::span<const std::byte> file) {
    return Reader(file).read();
}

}  // namespace bendy::fuzz
