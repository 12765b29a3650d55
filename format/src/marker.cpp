#include <bendy/format/marker.h>

#include <bendy/format/chunk_writer.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <string>

namespace bendy {
namespace {

constexpr std::uint64_t size_before_names(std::uint64_t markers) {
    return sizeof(MarkersRecord) + markers * sizeof(MarkerRecord);
}

/// Splits the names, which are stored without separators; returns false, and adds a fault, if they do not fill `names`.
bool cut_names(std::span<const MarkerRecord> records, std::string_view names, std::uint64_t offset,
               std::vector<Marker>& markers, Faults& faults) {
    markers.reserve(records.size());
    std::uint32_t begin = 0;
    for (const MarkerRecord& record : records) {
        if (record.name_end < begin || record.name_end > names.size()) {
            faults.add({ErrorCode::kMarkerName, offset, markers.size()});
            return false;
        }
        markers.push_back({record.seconds, names.substr(begin, record.name_end - begin)});
        begin = record.name_end;
    }
    if (begin == names.size()) return true;
    const std::uint64_t before = size_before_names(records.size());
    faults.add({ErrorCode::kRecordSize, offset, before + names.size(), before + begin});
    return false;
}

}  // namespace

std::optional<std::vector<Marker>> read_markers(Bytes payload, std::uint64_t offset, Faults& faults) {
    if (payload.size() < sizeof(MarkersRecord)) {
        faults.add({ErrorCode::kRecordTooShort, offset, payload.size(), sizeof(MarkersRecord)});
        return std::nullopt;
    }
    MarkersRecord record;
    copy_at(payload, 0, record);
    check_reserved(std::array{record.reserved}, offset, faults);
    if (record.markers > (payload.size() - sizeof(MarkersRecord)) / sizeof(MarkerRecord)) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), size_before_names(record.markers)});
        return std::nullopt;
    }
    const auto records = view_at<MarkerRecord>(payload, sizeof(MarkersRecord), record.markers);
    std::vector<Marker> markers;
    if (!cut_names(records, as_text(payload.subspan(size_before_names(record.markers))), offset, markers, faults))
        return std::nullopt;
    if (std::all_of(markers.begin(), markers.end(), [](const Marker& marker) { return is_utf8(marker.name); }))
        return markers;
    faults.add({ErrorCode::kNotUtf8, offset});
    return std::nullopt;
}

std::vector<std::byte> write_markers(std::span<const Marker> markers) {
    const MarkersRecord record{static_cast<std::uint32_t>(markers.size()), 0};
    std::vector<MarkerRecord> records;
    records.reserve(markers.size());
    std::string names;
    for (const Marker& marker : markers) {
        names += marker.name;
        assert(names.size() <= std::numeric_limits<std::uint32_t>::max());
        records.push_back({marker.seconds, static_cast<std::uint32_t>(names.size())});
    }
    std::vector<std::byte> payload;
    payload.reserve(size_before_names(markers.size()) + names.size());
    for (const Bytes part : {bytes_of(record), std::as_bytes(std::span(records)), as_byte_span(names)})
        payload.insert(payload.end(), part.begin(), part.end());
    return payload;
}

}  // namespace bendy
