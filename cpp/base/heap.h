#pragma once

namespace mortier {

/// For a program at its start, where freed memory is to stay in the heap and the heap is to be mapped in large
/// pages: a run takes the same memory again and again, and every page that the system maps anew costs as much
/// as the values of several hundred numbers in it. Nothing happens where the C library is not GNU's.
void keepHeap();

}  // namespace mortier
