// SPDX-License-Identifier: Apache-2.0
// What the leak checker of the sanitised build is to let pass.

#ifdef __SANITIZE_ADDRESS__
extern "C" const char* __lsan_default_suppressions();
/// VTK 9.1's reader of VTP loses an array iterator, and what hangs on it, where the number of components of a damaged
/// file's points is wrong. The memory is VTK's: we cannot free it.
extern "C" const char* __lsan_default_suppressions() { return "leak:vtkArrayIteratorTemplate\n"; }
#endif
