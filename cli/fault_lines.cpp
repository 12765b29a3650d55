#include "fault_lines.h"

#include "problem.h"

#include <bendy/format/diagnostics.h>

#include <ostream>

namespace bendy::cli {

void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes) {
    for (const Error& fault : faults.list())
        out << shown_name(file) << ": " << code_name(fault.code) << ": " << describe_with_place(fault, bytes) << '\n';
    if (faults.left_out() != 0) out << shown_name(file) << ": " << grouped(faults.left_out()) << " more faults\n";
}

}  // namespace bendy::cli
