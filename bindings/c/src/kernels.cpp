// The kernels of this machine, and the one in use.
#include "calls.h"
#include "fail.h"
#include "fields.h"

#include <bendy/runtime/kernels.h>

#include <string>

using namespace bendy::capi;

uint32_t bendy_kernel_count() {
    return static_cast<uint32_t>(bendy::kernels().size());
}

const char* bendy_kernel_name(uint32_t number) {
    const auto kernels = bendy::kernels();
    return number < kernels.size() ? bendy::kernel_name(kernels[number]).data() : nullptr;  // a literal
}

const char* bendy_kernel() {
    return bendy::kernel_name(bendy::kernel()).data();  // a literal
}

bendy_status bendy::capi::set_kernel(const char* name, bendy_error* error) {
    std::string there;
    for (const bendy::Kernel kernel : bendy::kernels()) {
        if (bendy::kernel_name(kernel) == name) {
            return from_call(bendy::set_kernel(kernel), error);
        }
        there += (there.empty() ? "" : ", ") + std::string(bendy::kernel_name(kernel));
    }
    return fail(error, BENDY_NOT_FOUND,
                "there is no kernel \"" + std::string(name) + "\" on this machine; there are: " + there);
}
