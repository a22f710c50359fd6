/// A limit on the process's address space (ulimit -v).
#pragma once

namespace emscape {

bool hasAddressLimit();

/// Where there is one, all threads share one store of malloc(), of which each would otherwise reserve 64 MiB
/// for its own. To be called before threads start.
void spareAddresses();

}  // namespace emscape
