// Memory in large pages for large scenes.
//
// A scene of 100 000 bodies takes some gigabytes, most of it once: in pages of 4 kB half of the time to the first step
// can be the system's, which hands them out one by one, and that of the processor's search for them (figures in
// bench/README.md). glibc asks for pages of 2 MB only where its environment says so when a program begins. Arrays of
// 4 MB and more get pages of their own, which go back to the system with them: what a start needs leaves no holes that
// the rest of the run does not fit into.
#pragma once

namespace poinsot::app {

// Begins the program anew with that said, where one of main's arguments is a large file, and for `scale`; else, and
// where it cannot, returns. Before anything else; what GLIBC_TUNABLES holds already stays.
void begin_in_large_pages(char** arguments);

}  // namespace poinsot::app
