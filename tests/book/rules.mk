# The book, tried out in headless browsers.
.PHONY: test-book
#: maintaining: make test-book    open every page of the book in Chromium and Firefox, and use what is live (5 minutes; needs npm)
test-book: book programs
	tests/book/run out/book $(BUILD)
