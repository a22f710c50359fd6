// Reports that lie in Debian's libraries, not in this project. Read by the sanitizers at the start of every
// program.

// Debian's libraries are not instrumented: the sanitizer misses how OpenVDB and oneTBB hand data from thread
// to thread. OpenVDB's templates are compiled into emscape_vdb.so, whose symbols are hidden. Our own loops do
// not use oneTBB here (base/parallel.cpp) and are checked in full. GDAL takes its locks in changing order.
// Cairo hands freed objects from thread to thread by atomic operations, and so do fontconfig and HarfBuzz.
// Pango reads fonts in a thread of its own. Mesa's software rasterizer (swrast_dri) destroys a fence while
// one of its own threads still leaves it.
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libtbb.so\n"
         "race:libopenvdb.so\n"
         "race:emscape_vdb.so\n"
         "race:libz.so\n"
         "race:libcairo.so\n"
         "race:libfontconfig.so\n"
         "race:libharfbuzz.so\n"
         "race:libpango-1.0.so\n"
         "race:libpangocairo-1.0.so\n"
         "race:libpangoft2-1.0.so\n"
         "race:libglib-2.0.so\n"
         "race:swrast_dri.so\n"
         "race:tbb::detail::\n"
         "deadlock:libgdal.so\n";
}

// Where a library is opened while the program runs (Mesa's driver), the address sanitizer takes the size of
// its thread-local block from the words before it, which glibc does not always write; the leak check then
// read there and ended the program (gcc 12, glibc 2.36). Its blocks are not searched for pointers.
extern "C" const char* __asan_default_options() {
  return "intercept_tls_get_addr=0";
}

extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";  // what a program writes to standard error is its own
}

// Fontconfig keeps what it has read until the process ends, and cairo does not hand it back. The record of an
// observer of oneTBB lives until its worker threads have left the arena; they may still be in it when the
// process ends, and keep the pointer in memory of oneTBB's own allocator, where the sanitizer does not look.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig.so\n"
         "leak:tbb::detail::r1::observe\n";
}
