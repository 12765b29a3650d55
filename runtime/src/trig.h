#pragma once

#include <bendy/format/trig.h>
