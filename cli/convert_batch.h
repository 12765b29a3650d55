#pragma once

#include "convert_arguments.h"

namespace bendy::cli {

/// Converts the inputs into the folder that is the output, several at a time; only what has changed. Prints what went
/// wrong with which file, and a table at the end; throws Failed if there was anything.
void convert_batch(const ConvertArguments& arguments);

}  // namespace bendy::cli
