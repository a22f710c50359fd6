/// The variables of GDAL and PROJ in the environment of a program.
#pragma once

namespace emscape::gdal {

/// Removes the variables of GDAL and PROJ from the environment of the process, but those that name folders of
/// their data or a size of memory: what is read and written does not depend on them. They are to print
/// nothing, and HDF5 is to lock no files. For the beginning of a program, before it starts threads.
void ignoreEnvironment();

}  // namespace emscape::gdal
