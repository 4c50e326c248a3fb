#pragma once

namespace mortier {

/// At the start of a program: memory that is freed stays in the heap, which is mapped in large pages. A run
/// takes and frees the same memory again and again, and pages that are mapped anew cost as much time as the
/// work in them. Only with GNU's C library.
void keepHeap();

}  // namespace mortier
