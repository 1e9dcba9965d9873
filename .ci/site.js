"use strict";
// Blocks that scroll sideways can be reached and scrolled by keyboard.
for (const block of document.querySelectorAll(".highlight pre, .table-wrapper")) block.tabIndex = 0;
