"use strict";
// Blocks that scroll sideways can be reached and scrolled by keyboard.
for (const block of document.querySelectorAll(".highlight pre, .table-wrapper, .math-wrapper")) block.tabIndex = 0;
// The theme leaves captions without a level and two side bars without names.
for (const caption of document.querySelectorAll('.caption[role="heading"]')) caption.ariaLevel = 2;
document.querySelector(".sidebar-drawer").ariaLabel = "Pages";
const contents = document.querySelector(".toc-drawer");
if (contents) contents.ariaLabel = "On this page";
