#include "base/dense_templates.h"

MORTIER_DENSE_TEMPLATES()
