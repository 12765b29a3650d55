#pragma once

#include "convert/conversion.h"

namespace bendy::cli {

/// Converts the inputs into the folder that is the output, or each beside itself where none is given, several at a
/// time; only what has changed. Prints a line for each file, in order, what went wrong with which, and a table at the
/// end; throws Failed if there was anything.
void convert_batch(const ConvertArguments& arguments);

}  // namespace bendy::cli
