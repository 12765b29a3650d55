// The library's version and its kernels.
#include "fail.h"

#include <bendy/runtime/kernels.h>

#define BENDY_TEXT_OF(number) #number
#define BENDY_DOTTED(major, minor, patch) BENDY_TEXT_OF(major) "." BENDY_TEXT_OF(minor) "." BENDY_TEXT_OF(patch)

using namespace bendy::capi;

uint32_t bendy_version() {
    return BENDY_VERSION_MAJOR << 16U | BENDY_VERSION_MINOR << 8U | BENDY_VERSION_PATCH;
}

const char* bendy_version_string() {
    return BENDY_DOTTED(BENDY_VERSION_MAJOR, BENDY_VERSION_MINOR, BENDY_VERSION_PATCH);
}

const char* bendy_kernel() {
    return bendy::kernel_name(bendy::kernel()).data();  // a literal
}

bendy_status bendy_set_kernel(const char* name, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        std::string there;
        for (const bendy::Kernel kernel : bendy::kernels()) {
            if (bendy::kernel_name(kernel) == name) {
                return from_call(bendy::set_kernel(kernel), error);
            }
            there += (there.empty() ? "" : ", ") + std::string(bendy::kernel_name(kernel));
        }
        return fail(error, BENDY_NOT_FOUND,
                    "there is no kernel \"" + std::string(name) + "\" on this machine; there are: " + there);
    });
}
