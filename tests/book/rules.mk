# The book, tried out in headless Chromium.
.PHONY: test-book
#: make test-book    open every page of the book in Chromium, and use what is live in it
test-book: book programs
	tests/book/run out/book $(BUILD)
